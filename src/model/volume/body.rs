//! The true shapes of objects, and what they share with boxes.

use std::borrow::Cow;

use super::part::{Part, Region, dot};
use crate::geometry::{ball_box_volume, ball_column_volume, disc_rectangle_area, half_space_share};
use crate::model::{Grid, MaterialId, Object, Voxels};

/// A share that is left out of account: of single precision, and less than any coordinate in a file is good for.
pub const NEGLIGIBLE: f64 = 1e-7;

/// A body where it is, not where it snaps to.
pub struct Body<'a> {
    /// Bounds, m.
    pub low: [f64; 3],
    /// Bounds, m.
    pub high: [f64; 3],
    /// What it is made of; that of a block of cells stands with each of them.
    pub material: MaterialId,
    shape: Shape<'a>,
}

enum Shape<'a> {
    Box,
    /// Half-axes along x, y, z.
    Ball {
        centre: [f64; 3],
        radii: [f64; 3],
    },
    /// A cylinder along an axis.
    Rod {
        along: usize,
        centre: [f64; 3],
        radius: f64,
    },
    /// What lies inside of all of these.
    Parts(Vec<Part>),
    Cells {
        voxels: Cow<'a, Voxels>,
        spacing: [f64; 3],
    },
}

/// How a surface lies: products of the parts of its normal `n`, of length 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slope {
    /// `n_x²`, `n_y²`, `n_z²`, which add up to 1.
    pub squares: [f64; 3],
    /// `n_y n_z`, `n_z n_x`, `n_x n_y`.
    pub products: [f64; 3],
}

/// How a body lies to a box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Side {
    Outside,
    /// It fills the box with this.
    Inside(MaterialId),
    Cut,
}

/// The two other axes, in cyclic order.
const OTHERS: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];

impl<'a> Body<'a> {
    /// The true shape of an object; `None` for what has no volume: plates, edges, prisms and sectors without thickness.
    pub fn of(object: &'a Object, grid: &Grid) -> Option<Self> {
        let body = |low: [f64; 3], high: [f64; 3], material, shape| {
            (0..3).all(|axis| high[axis] > low[axis]).then_some(Self { low, high, material, shape })
        };
        match *object {
            Object::Box { lower, upper, material, .. } => body(lower, upper, material, Shape::Box),
            Object::Sphere { centre, radius, material, .. } => ball(centre, [radius; 3], material),
            Object::Ellipsoid { centre, radii, material, .. } => ball(centre, radii, material),
            Object::Cylinder { start, end, radius, material, .. } => cone(start, end, [radius; 2], material),
            Object::Cone { start, end, radii, material, .. } => cone(start, end, radii, material),
            Object::Triangle { corners, axis, thickness, material, .. } => {
                let along = axis.index();
                let mut low: [f64; 3] = std::array::from_fn(|a| corners.iter().fold(f64::INFINITY, |v, c| v.min(c[a])));
                let mut high: [f64; 3] =
                    std::array::from_fn(|a| corners.iter().fold(f64::NEG_INFINITY, |v, c| v.max(c[a])));
                (low[along], high[along]) = (corners[0][along], corners[0][along] + thickness);
                let middle: [f64; 3] = std::array::from_fn(|a| corners.iter().map(|c| c[a]).sum::<f64>() / 3.0);
                let [p, q] = OTHERS[along];
                let mut parts = ends(along, low[along], high[along]);
                for from in 0..3 {
                    let (a, b) = (corners[from], corners[(from + 1) % 3]);
                    let mut normal = [0.0; 3];
                    (normal[p], normal[q]) = (b[q] - a[q], a[p] - b[p]);
                    parts.push(away_from(middle, a, normal)?);
                }
                body(low, high, material, Shape::Parts(parts))
            }
            Object::Sector { axis, centre, extent, radius, start, sweep, material, .. } => {
                let along = axis.index();
                let [p, q] = if along == 1 { [0, 2] } else { OTHERS[along] };
                let mut at = [extent[0]; 3];
                (at[p], at[q]) = (centre[0], centre[1]);
                let (mut low, mut high) = (at.map(|v| v - radius), at.map(|v| v + radius));
                (low[along], high[along]) = (extent[0], extent[1]);
                let mut direction = [0.0; 3];
                direction[along] = 1.0;
                let mut parts = ends(along, extent[0], extent[1]);
                parts.push(Part::Mantle { start: at, axis: direction, radius, growth: 0.0 });
                if sweep < 360.0 {
                    // The plane at an angle: inside is to the left of the first and to the right of the second.
                    let plane = |angle: f64, sign: f64| {
                        let (sin, cos) = angle.to_radians().sin_cos();
                        let mut normal = [0.0; 3];
                        (normal[p], normal[q]) = (sign * sin, -sign * cos);
                        (normal, dot(normal, at))
                    };
                    let both = [plane(start, 1.0), plane(start + sweep, -1.0)];
                    if sweep > 180.0 {
                        parts.push(Part::Either(both));
                    } else {
                        // Of half a turn both planes are the same one.
                        let planes = both.into_iter().take(if sweep == 180.0 { 1 } else { 2 });
                        parts.extend(planes.map(|(normal, offset)| Part::HalfSpace { normal, offset }));
                    }
                }
                body(low, high, material, Shape::Parts(parts))
            }
            Object::Voxels(ref voxels) => Self::block(Cow::Borrowed(voxels), grid),
            Object::Fractal(ref fractal) => Self::block(Cow::Owned(fractal.voxels(grid)), grid),
            Object::Plate { .. } | Object::Edge { .. } => None,
        }
    }

    /// A block of cells, snapped as it is.
    fn block(voxels: Cow<'a, Voxels>, grid: &Grid) -> Option<Self> {
        let node = |axis: usize| grid.node(axis, voxels.origin[axis]) as f64 * grid.spacing[axis];
        let low: [f64; 3] = std::array::from_fn(node);
        let high: [f64; 3] = std::array::from_fn(|axis| low[axis] + voxels.shape[axis] as f64 * grid.spacing[axis]);
        let shape = Shape::Cells { voxels, spacing: grid.spacing };
        (0..3).all(|axis| high[axis] > low[axis]).then_some(Self { low, high, material: MaterialId::FREE_SPACE, shape })
    }

    /// How it lies to a box.
    pub fn side(&self, region: &Region) -> Side {
        let size = region.size();
        let mut within = true;
        for (axis, &size) in size.iter().enumerate() {
            let slack = NEGLIGIBLE * size;
            if region.high[axis] <= self.low[axis] + slack || region.low[axis] >= self.high[axis] - slack {
                return Side::Outside;
            }
            within &= self.low[axis] <= region.low[axis] + slack && region.high[axis] <= self.high[axis] + slack;
        }
        let inside = match self.shape {
            Shape::Box => Some(true),
            Shape::Ball { centre, radii } => {
                let of = |axis: usize| far_and_near(region, axis, centre[axis], radii[axis]);
                round([of(0), of(1), of(2)])
            }
            Shape::Rod { along, centre, radius } => {
                let of = |axis: usize| far_and_near(region, axis, centre[axis], radius);
                let [p, q] = OTHERS[along];
                round([of(p), of(q), [0.0; 2]])
            }
            Shape::Parts(ref parts) => {
                let sides = || parts.iter().map(|part| part.side(region));
                if sides().any(|side| side == Some(false)) {
                    Some(false)
                } else {
                    sides().all(|side| side == Some(true)).then_some(true)
                }
            }
            Shape::Cells { ref voxels, spacing } => {
                let cell = |at: [f64; 3]| -> [f64; 3] {
                    std::array::from_fn(|axis| ((at[axis] - self.low[axis]) / spacing[axis]).floor())
                };
                let slack = size.map(|s| NEGLIGIBLE * s);
                let first = cell(std::array::from_fn(|axis| region.low[axis] + slack[axis]));
                if first != cell(std::array::from_fn(|axis| region.high[axis] - slack[axis])) {
                    return Side::Cut;
                }
                let [i, j, k] = first.map(|v| v.max(0.0) as usize);
                let [_, my, mz] = voxels.shape;
                return match voxels.cells.get((i * my + j) * mz + k).copied().flatten() {
                    Some(material) => Side::Inside(material),
                    None => Side::Outside,
                };
            }
        };
        match inside {
            Some(true) if within => Side::Inside(self.material),
            Some(false) => Side::Outside,
            _ => Side::Cut,
        }
    }

    /// Where to cut a box so that it becomes simpler: a face of a box, the end of a cylinder, the border of a cell.
    pub fn plane(&self, region: &Region) -> Option<(usize, f64)> {
        let size = region.size();
        let between = |axis: usize, at: f64| {
            let slack = NEGLIGIBLE * size[axis];
            at > region.low[axis] + slack && at < region.high[axis] - slack
        };
        let face = |axis: usize| {
            [self.low[axis], self.high[axis]].into_iter().find(|&at| between(axis, at)).map(|at| (axis, at))
        };
        match self.shape {
            Shape::Box => (0..3).find_map(face),
            Shape::Rod { along, .. } => face(along),
            Shape::Ball { .. } | Shape::Parts(_) => None,
            Shape::Cells { spacing, .. } => (0..3).find_map(|axis| {
                let cell = ((region.low[axis] - self.low[axis]) / spacing[axis] + NEGLIGIBLE).floor() + 1.0;
                let at = self.low[axis] + cell.max(0.0) * spacing[axis];
                between(axis, at).then_some((axis, at))
            }),
        }
    }

    /// Whether [`Body::share`] is exact.
    pub fn is_exact(&self) -> bool {
        matches!(self.shape, Shape::Box | Shape::Ball { .. } | Shape::Rod { .. })
    }

    /// Share of a box that it fills, 0 to 1.
    pub fn share(&self, region: &Region) -> f64 {
        let size = region.size();
        let overlap = |axis: usize| {
            ((region.high[axis].min(self.high[axis]) - region.low[axis].max(self.low[axis])) / size[axis])
                .clamp(0.0, 1.0)
        };
        let from = |at: [f64; 3], centre: [f64; 3]| -> [f64; 3] { std::array::from_fn(|axis| at[axis] - centre[axis]) };
        let share = match self.shape {
            Shape::Box => overlap(0) * overlap(1) * overlap(2),
            Shape::Ball { centre, radii } => {
                let of = |at| -> [f64; 3] {
                    let from = from(at, centre);
                    std::array::from_fn(|axis| from[axis] / radii[axis])
                };
                let volume: f64 = size.iter().zip(radii).map(|(s, r)| s / r).product();
                ball_box_volume(1.0, of(region.low), of(region.high)) / volume
            }
            Shape::Rod { along, centre, radius } => {
                let [p, q] = OTHERS[along];
                let (low, high) = (from(region.low, centre), from(region.high, centre));
                let area = disc_rectangle_area(radius, low[p], high[p], low[q], high[q]);
                overlap(along) * area / (size[p] * size[q])
            }
            Shape::Parts(ref parts) => parts.iter().map(|part| part.share(region)).product(),
            Shape::Cells { .. } => 0.0,
        };
        share.clamp(0.0, 1.0)
    }

    /// As [`Body::share`] of a box much smaller than the body: a ball taken as even but for its curvature, to about a
    /// thousandth of a box of a quarter of the radius and the less the smaller it is.
    pub fn share_of_part(&self, region: &Region) -> f64 {
        let Shape::Ball { centre, radii } = self.shape else { return self.share(region) };
        let size: [f64; 3] = std::array::from_fn(|axis| (region.high[axis] - region.low[axis]) / radii[axis]);
        let middle = region.middle();
        let from: [f64; 3] = std::array::from_fn(|axis| (middle[axis] - centre[axis]) / radii[axis]);
        let distance = dot(from, from).sqrt();
        if size.iter().any(|s| *s > 0.25) || distance < 0.5 {
            return self.share(region);
        }
        let normal = from.map(|v| v / distance);
        let bulge = (0..3).map(|a| (1.0 - normal[a] * normal[a]) * size[a] * size[a]).sum::<f64>() / (24.0 * distance);
        half_space_share(distance - 1.0 + bulge, normal, size)
    }

    /// Share of the column of boxes over a rectangle that a ball fills beyond a height, in boxes like `region`, whose sides
    /// along x and y are those of the rectangle. `None` for other bodies.
    pub fn beyond(&self, region: &Region, z: f64) -> Option<f64> {
        let Shape::Ball { centre, radii } = self.shape else { return None };
        let of = |axis: usize| [region.low[axis], region.high[axis]].map(|v| (v - centre[axis]) / radii[axis]);
        let volume: f64 = region.size().iter().zip(radii).map(|(s, r)| s / r).product();
        Some(ball_column_volume(of(0), of(1), (z - centre[2]) / radii[2]) / volume)
    }

    /// How its surface lies within a box that it cuts.
    pub fn slope(&self, region: &Region) -> Slope {
        let middle = region.middle();
        let slope = |normal: [f64; 3]| {
            let length = dot(normal, normal);
            if length <= 0.0 {
                return Slope { squares: [1.0 / 3.0; 3], products: [0.0; 3] };
            }
            let product = |axis: usize| normal[OTHERS[axis][0]] * normal[OTHERS[axis][1]] / length;
            Slope { squares: normal.map(|v| v * v / length), products: std::array::from_fn(product) }
        };
        // Of the faces that pass through the box, each as much as the others, and each by itself.
        let flat = |is_cut: &dyn Fn(usize) -> bool| Slope {
            products: [0.0; 3],
            ..slope(std::array::from_fn(|axis| if is_cut(axis) { 1.0 } else { 0.0 }))
        };
        let face = |axis: usize| {
            let slack = NEGLIGIBLE * (region.high[axis] - region.low[axis]);
            let is_within = |at: f64| at > region.low[axis] + slack && at < region.high[axis] - slack;
            is_within(self.low[axis]) || is_within(self.high[axis])
        };
        match self.shape {
            Shape::Box => flat(&face),
            Shape::Ball { centre, radii } => {
                slope(std::array::from_fn(|axis| (middle[axis] - centre[axis]) / radii[axis].powi(2)))
            }
            Shape::Rod { along, .. } if face(along) => flat(&|axis| axis == along),
            Shape::Rod { along, centre, .. } => {
                slope(std::array::from_fn(|axis| if axis == along { 0.0 } else { middle[axis] - centre[axis] }))
            }
            Shape::Parts(ref parts) => {
                let cut = parts.iter().filter(|part| part.side(region).is_none());
                slope(cut.map(|part| part.normal(middle)).next().unwrap_or_default())
            }
            Shape::Cells { spacing, .. } => flat(&|axis| {
                let at = |v: f64| ((v - self.low[axis]) / spacing[axis] + NEGLIGIBLE).floor();
                at(region.low[axis]) != at(region.high[axis] - 2.0 * NEGLIGIBLE * spacing[axis])
            }),
        }
    }

    /// Whether two bodies are known to have no common volume.
    pub fn is_apart(&self, other: &Self) -> bool {
        let distance = |a: [f64; 3], b: [f64; 3], axes: &[usize]| {
            axes.iter().map(|&axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
        };
        match (&self.shape, &other.shape) {
            (Shape::Ball { centre: a, radii: r }, Shape::Ball { centre: b, radii: s }) => {
                let longest = |radii: &[f64; 3]| radii.iter().fold(0.0f64, |longest, r| longest.max(*r));
                let both = longest(r) + longest(s);
                distance(*a, *b, &[0, 1, 2]) >= both * (1.0 - 1e-12)
            }
            (Shape::Rod { along, centre: a, radius: r }, Shape::Rod { along: other, centre: b, radius: s }) => {
                along == other && distance(*a, *b, &OTHERS[*along]) >= (r + s) * (1.0 - 1e-12)
            }
            _ => false,
        }
    }

    /// The boxes of a row that it fills and those that it touches, as ranges of coordinates along z, for a ball; the row is
    /// that of `region` along x and y. `None`: ask each box.
    pub fn run(&self, region: &Region) -> Option<[[f64; 2]; 2]> {
        let Shape::Ball { centre, radii } = self.shape else { return None };
        let of = |axis: usize| far_and_near(region, axis, centre[axis], radii[axis]);
        let ([far_x, near_x], [far_y, near_y]) = (of(0), of(1));
        let half = |p: f64, q: f64| {
            let left = 1.0 - p * p - q * q;
            if left > 0.0 { left.sqrt() * radii[2] } else { -f64::INFINITY }
        };
        let about = |half: f64| [centre[2] - half, centre[2] + half];
        Some([about(half(far_x, far_y)), about(half(near_x, near_y))])
    }
}

fn ball<'a>(centre: [f64; 3], radii: [f64; 3], material: MaterialId) -> Option<Body<'a>> {
    let low = std::array::from_fn(|axis| centre[axis] - radii[axis]);
    let high = std::array::from_fn(|axis| centre[axis] + radii[axis]);
    radii.iter().all(|r| *r > 0.0).then_some(Body { low, high, material, shape: Shape::Ball { centre, radii } })
}

fn cone<'a>(start: [f64; 3], end: [f64; 3], radii: [f64; 2], material: MaterialId) -> Option<Body<'a>> {
    let way: [f64; 3] = std::array::from_fn(|axis| end[axis] - start[axis]);
    let length = dot(way, way).sqrt();
    if length.is_nan() || length <= 0.0 {
        return None;
    }
    let axis = way.map(|v| v / length);
    // A disc across `axis` reaches `r sqrt(1 - axis²)` along each axis of the grid.
    let wide = |a: usize, radius: f64| radius * (1.0 - axis[a] * axis[a]).max(0.0).sqrt();
    let low = std::array::from_fn(|a| (start[a] - wide(a, radii[0])).min(end[a] - wide(a, radii[1])));
    let high = std::array::from_fn(|a| (start[a] + wide(a, radii[0])).max(end[a] + wide(a, radii[1])));
    let straight = (0..3).find(|&a| way[OTHERS[a][0]] == 0.0 && way[OTHERS[a][1]] == 0.0);
    let shape = match straight {
        Some(along) if radii[0] == radii[1] => Shape::Rod { along, centre: start, radius: radii[0] },
        _ => {
            let growth = (radii[1] - radii[0]) / length;
            let mantle = Part::Mantle { start, axis, radius: radii[0], growth };
            let face = |sign: f64, at: [f64; 3]| {
                let normal = axis.map(|v| sign * v);
                Part::HalfSpace { normal, offset: dot(normal, at) }
            };
            Shape::Parts(vec![face(-1.0, start), face(1.0, end), mantle])
        }
    };
    Some(Body { low, high, material, shape })
}

/// The half-spaces between two coordinates along an axis.
fn ends(along: usize, low: f64, high: f64) -> Vec<Part> {
    let plane = |sign: f64, at: f64| {
        let mut normal = [0.0; 3];
        normal[along] = sign;
        Part::HalfSpace { normal, offset: sign * at }
    };
    vec![plane(-1.0, low), plane(1.0, high)]
}

/// The side on which a point lies of a plane through another; `None` for a normal of no length.
fn away_from(inside: [f64; 3], on: [f64; 3], normal: [f64; 3]) -> Option<Part> {
    let length = dot(normal, normal).sqrt();
    let normal = normal.map(|v| v / length);
    let offset = dot(normal, on);
    let outwards = dot(normal, inside) <= offset;
    let part = if outwards {
        Part::HalfSpace { normal, offset }
    } else {
        Part::HalfSpace { normal: normal.map(|v| -v), offset: -offset }
    };
    (length > 0.0).then_some(part)
}

/// The largest and the smallest distance of a box from a centre along an axis, in radii.
fn far_and_near(region: &Region, axis: usize, centre: f64, radius: f64) -> [f64; 2] {
    let (low, high) = ((region.low[axis] - centre) / radius, (region.high[axis] - centre) / radius);
    [low.abs().max(high.abs()), low.max(-high).max(0.0)]
}

/// Whether what lies within a unit ball holds a box of these distances.
fn round(distances: [[f64; 2]; 3]) -> Option<bool> {
    let squared = |of: usize| distances.iter().map(|d| d[of] * d[of]).sum::<f64>();
    if squared(0) <= 1.0 {
        Some(true)
    } else if squared(1) >= 1.0 {
        Some(false)
    } else {
        None
    }
}
