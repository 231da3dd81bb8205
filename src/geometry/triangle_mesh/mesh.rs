//! A checked mesh of triangles with named patches.

use serde::{Deserialize, Serialize};

use crate::units::Metres;

use super::error::MeshError;
use super::features::Features;
use super::vector::{V3, add, cross, dot, length, scaled, sub};

/// The widest mesh that is believed to be in metres.
const WIDEST: Metres = Metres(1000.0);
/// The narrowest mesh that is believed to be in metres: a tenth of a grain of sand.
const NARROWEST: f64 = 1e-4;
/// Height over longest side below which a triangle has no area; single precision, as STL has it, keeps 1e-7.
const FLAT: f64 = 1e-7;

/// Points and the triangles between them, checked once, with the features a ball may touch.
///
/// Coordinates in metres. Triangles count their corners against the clock when seen from outside; sheets (open meshes) may
/// be touched from both sides. Each triangle belongs to one named patch, so that forces can be told per face.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(try_from = "Plain", into = "Plain")]
pub struct TriangleMesh {
    points: Vec<V3>,
    triangles: Vec<[u32; 3]>,
    patch_of: Vec<u16>,
    patches: Vec<String>,
    pub(super) features: Features,
}

/// What of a mesh is kept in files; the rest follows.
#[derive(Clone, Serialize, Deserialize)]
struct Plain {
    points: Vec<V3>,
    triangles: Vec<[u32; 3]>,
    patch_of: Vec<u16>,
    patches: Vec<String>,
}

impl TryFrom<Plain> for TriangleMesh {
    type Error = MeshError;

    fn try_from(plain: Plain) -> Result<Self, MeshError> {
        let mut mesh = Self::new(plain.points, plain.triangles)?;
        if plain.patch_of.len() == mesh.triangles.len()
            && plain.patch_of.iter().all(|&patch| usize::from(patch) < plain.patches.len())
        {
            (mesh.patch_of, mesh.patches) = (plain.patch_of, plain.patches);
        }
        Ok(mesh)
    }
}

impl From<TriangleMesh> for Plain {
    fn from(mesh: TriangleMesh) -> Self {
        Self { points: mesh.points, triangles: mesh.triangles, patch_of: mesh.patch_of, patches: mesh.patches }
    }
}

impl PartialEq for TriangleMesh {
    fn eq(&self, other: &Self) -> bool {
        self.points == other.points
            && self.triangles == other.triangles
            && self.patch_of == other.patch_of
            && self.patches == other.patches
    }
}

impl TriangleMesh {
    /// Checks points (m) and triangles, all of one patch, `surface`.
    ///
    /// # Errors
    /// A point that is no place, an index out of range, a triangle without area, an extent that tells of other units.
    pub fn new(points: Vec<V3>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        if triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        if let Some(point) = points.iter().position(|point| point.iter().any(|v| !v.is_finite())) {
            return Err(MeshError::NotAPlace { point, at: points[point] });
        }
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&index) = corners.iter().find(|&&index| index as usize >= points.len()) {
                return Err(MeshError::NoSuchPoint { triangle, index, points: points.len() });
            }
        }
        let width = width(&points, &triangles);
        if width > WIDEST.si() {
            return Err(MeshError::TooWide { width: Metres(width), limit: WIDEST });
        }
        for (triangle, corners) in triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|index| points[index as usize]);
            let (ab, bc, ca) = (sub(b, a), sub(c, b), sub(a, c));
            let longest = dot(ab, ab).max(dot(bc, bc)).max(dot(ca, ca));
            if length(cross(ab, ca)) <= FLAT * longest {
                return Err(MeshError::NoArea { triangle, corners: [a, b, c] });
            }
        }
        if width < NARROWEST {
            return Err(MeshError::TooNarrow { width: Metres(width) });
        }
        let features = Features::of(&points, &triangles);
        let patch_of = vec![0; triangles.len()];
        Ok(Self { points, triangles, patch_of, patches: vec!["surface".into()], features })
    }

    /// Gives all triangles to one patch.
    pub fn named(mut self, patch: &str) -> Self {
        self.patch_of.fill(0);
        self.patches = vec![patch.into()];
        self
    }

    /// Gives each triangle to a patch by what `name` says of it; patches keep the order in which they first occur.
    pub fn with_patches(mut self, mut name: impl FnMut(usize) -> String) -> Self {
        self.patches.clear();
        for triangle in 0..self.triangles.len() {
            let name = name(triangle);
            let known = self.patches.iter().position(|known| *known == name);
            let index = known.unwrap_or_else(|| {
                self.patches.push(name);
                self.patches.len() - 1
            });
            self.patch_of[triangle] = index as u16;
        }
        self
    }

    /// This mesh and another as one, each keeping its patches; points at the same place become one.
    ///
    /// # Errors
    /// As [`TriangleMesh::new`], for the whole.
    pub fn joined(&self, other: &Self) -> Result<Self, MeshError> {
        let corners = [self, other].into_iter().flat_map(|mesh| {
            (0..mesh.triangles.len()).map(|triangle| (mesh.corners(triangle), mesh.patch(triangle).to_owned()))
        });
        let (corners, names): (Vec<_>, Vec<_>) = corners.unzip();
        Ok(Self::from_soup(&corners)?.with_patches(|triangle| names[triangle].clone()))
    }

    /// A mesh from the corners of its triangles; points at the same place become one.
    ///
    /// # Errors
    /// As [`TriangleMesh::new`].
    pub fn from_soup(corners: &[[V3; 3]]) -> Result<Self, MeshError> {
        let mut known = std::collections::HashMap::new();
        let mut points = Vec::new();
        let triangles = corners.iter().map(|triangle| {
            triangle.map(|point| {
                // `-0.0` is the same place as `0.0`.
                let key = point.map(|v| (v + 0.0).to_bits());
                *known.entry(key).or_insert_with(|| {
                    points.push(point);
                    points.len() as u32 - 1
                })
            })
        });
        let triangles = triangles.collect();
        Self::new(points, triangles)
    }

    /// The mesh moved by a vector, m.
    ///
    /// # Errors
    /// When that leads out of all places.
    pub fn moved(&self, by: V3) -> Result<Self, MeshError> {
        self.with_points(self.points.iter().map(|&point| add(point, by)).collect())
    }

    /// The mesh with all coordinates times a factor, as from millimetres to metres with 0.001.
    ///
    /// # Errors
    /// When nothing is left of it, or too much.
    pub fn scaled(&self, by: f64) -> Result<Self, MeshError> {
        self.with_points(self.points.iter().map(|&point| scaled(point, by)).collect())
    }

    fn with_points(&self, points: Vec<V3>) -> Result<Self, MeshError> {
        let mesh = Self::new(points, self.triangles.clone())?;
        Ok(Self { patch_of: self.patch_of.clone(), patches: self.patches.clone(), ..mesh })
    }

    /// The points, m.
    pub fn points(&self) -> &[V3] {
        &self.points
    }

    /// The triangles: three indices into the points each.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The corners of a triangle, m.
    ///
    /// # Panics
    /// When there is no such triangle.
    pub fn corners(&self, triangle: usize) -> [V3; 3] {
        self.triangles[triangle].map(|index| self.points[index as usize])
    }

    /// Names of the patches.
    pub fn patches(&self) -> &[String] {
        &self.patches
    }

    /// Index of the patch of a triangle.
    ///
    /// # Panics
    /// When there is no such triangle.
    pub fn patch_index(&self, triangle: usize) -> usize {
        usize::from(self.patch_of[triangle])
    }

    /// Name of the patch of a triangle.
    ///
    /// # Panics
    /// When there is no such triangle.
    pub fn patch(&self, triangle: usize) -> &str {
        &self.patches[self.patch_index(triangle)]
    }

    /// The lowest and the highest coordinates, m.
    pub fn bounds(&self) -> [V3; 2] {
        bounds(self.triangles.iter().flatten().map(|&index| self.points[index as usize]))
    }

    /// The lowest and the highest coordinates of a triangle, m.
    ///
    /// # Panics
    /// When there is no such triangle.
    pub fn triangle_bounds(&self, triangle: usize) -> [V3; 2] {
        bounds(self.corners(triangle).into_iter())
    }

    /// Area of the surface, m².
    pub fn area(&self) -> f64 {
        let area = |triangle| {
            let [a, b, c] = self.corners(triangle);
            0.5 * length(cross(sub(b, a), sub(c, a)))
        };
        (0..self.triangles.len()).map(area).sum()
    }

    /// Volume inside, m³; negative for a mesh that is inside out, and without meaning for an open one.
    pub fn volume(&self) -> f64 {
        let middle = scaled(add(self.bounds()[0], self.bounds()[1]), 0.5);
        let part = |triangle| {
            let [a, b, c] = self.corners(triangle).map(|corner| sub(corner, middle));
            dot(a, cross(b, c)) / 6.0
        };
        (0..self.triangles.len()).map(part).sum()
    }

    /// Refuses a mesh that does not enclose a volume.
    ///
    /// # Errors
    /// The first edge with one triangle only, with more than two, or between two that face opposite ways.
    pub fn check_closed(&self) -> Result<(), MeshError> {
        let sides = self.features.edges_with_triangles();
        let ends = |edge: [u32; 2]| edge.map(|index| self.points[index as usize]);
        let open = sides.clone().filter(|(_, triangles)| triangles.len() == 1).count();
        for (edge, triangles) in sides {
            match triangles {
                [_] => return Err(MeshError::Open { edge, ends: ends(edge), open }),
                [first, second] => {
                    let forwards = |triangle: u32| {
                        let [a, b, c] = self.triangles[triangle as usize];
                        [[a, b], [b, c], [c, a]].contains(&edge)
                    };
                    if forwards(first.0) == forwards(second.0) {
                        let triangles = [first.0 as usize, second.0 as usize];
                        return Err(MeshError::Turned { triangles, ends: ends(edge) });
                    }
                }
                many => return Err(MeshError::Branched { edge, ends: ends(edge), triangles: many.len() }),
            }
        }
        Ok(())
    }
}

fn bounds(points: impl Iterator<Item = V3>) -> [V3; 2] {
    points.fold([[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]], |[low, high], point| {
        [std::array::from_fn(|k| low[k].min(point[k])), std::array::from_fn(|k| high[k].max(point[k]))]
    })
}

fn width(points: &[V3], triangles: &[[u32; 3]]) -> f64 {
    let [low, high] = bounds(triangles.iter().flatten().map(|&index| points[index as usize]));
    (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max)
}

#[cfg(test)]
#[path = "mesh_tests.rs"]
mod tests;
