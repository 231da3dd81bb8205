use super::*;
use crate::geometry::triangle_mesh::vector::{add, cross, unit};
use crate::geometry::triangle_mesh::{closed_box, open_box, rectangle};
use proptest::prelude::*;

fn touched(mesh: &TriangleMesh, centre: V3, radius: f64) -> Vec<Touch> {
    let all: Vec<u32> = (0..mesh.triangles().len() as u32).collect();
    let mut touches = Touches::new();
    mesh.touches(centre, radius, &all, &mut touches);
    let found = touches.as_slice().to_vec();
    // Neither the order of the candidates nor seeing one of them twice matters.
    let backwards: Vec<u32> = all.iter().rev().chain(&all).copied().collect();
    mesh.touches(centre, radius, &backwards, &mut touches);
    let features = |touches: &[Touch]| touches.iter().map(|touch| touch.feature).collect::<Vec<_>>();
    assert_eq!(features(touches.as_slice()), features(&found));
    found
}

/// A unit square floor cut at random: points strewn in it, each splitting the triangle it falls in into three, and sides
/// exchanged where that keeps both triangles; then turned and moved as a whole.
fn floor(seeds: &[(f64, f64)], flips: &[usize]) -> TriangleMesh {
    let mut points = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut triangles: Vec<[u32; 3]> = vec![[0, 1, 2], [0, 2, 3]];
    let area = |points: &[[f64; 2]], [a, b, c]: [u32; 3]| {
        let (a, b, c) = (points[a as usize], points[b as usize], points[c as usize]);
        0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    };
    for &(x, y) in seeds {
        let new = points.len() as u32;
        points.push([x, y]);
        let parts = |[a, b, c]: [u32; 3]| [[a, b, new], [b, c, new], [c, a, new]];
        let within = |corners: &[u32; 3]| parts(*corners).iter().all(|part| area(&points, *part) > 1e-4);
        match triangles.iter().position(within) {
            Some(at) => {
                let old = triangles.swap_remove(at);
                triangles.extend(parts(old));
            }
            None => {
                points.pop();
            }
        }
    }
    for &flip in flips {
        let at = flip % triangles.len();
        let [a, b, c] = triangles[at];
        let other =
            triangles.iter().position(|other| *other != triangles[at] && other.contains(&a) && other.contains(&b));
        if let Some(other) = other
            && let Some(&d) = triangles[other].iter().find(|&&d| d != a && d != b)
            && [[a, d, c], [d, b, c]].iter().all(|part| area(&points, *part) > 1e-4)
        {
            triangles[at] = [a, d, c];
            triangles[other] = [d, b, c];
        }
    }
    TriangleMesh::new(points.iter().map(|[x, y]| [*x, *y, 0.0]).collect(), triangles).unwrap()
}

/// A right-handed frame of unit vectors.
fn frame(of: V3) -> [V3; 3] {
    let w = unit(of);
    let u = unit(cross(if w[0].abs() < 0.7 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] }, w));
    [u, cross(w, u), w]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// A ball on a floor of triangles, anywhere on it, also over its sides and corners, feels the plane: one touch, the depth
    /// and the normal of the plane to 1e-12, and always the same feature. The floor lies askew and away from the origin.
    #[test]
    fn a_floor_of_triangles_is_a_plane(
        seeds in prop::collection::vec((0.02..0.98_f64, 0.02..0.98_f64), 0..40),
        flips in prop::collection::vec(0..1000_usize, 0..40),
        up in prop::array::uniform3(-1.0..1.0_f64), at in prop::array::uniform3(-2.0..2.0_f64),
        depth in 1e-7..0.05_f64, share in 0.0..1.0_f64, below in any::<bool>(),
    ) {
        prop_assume!(dot(up, up) > 0.01);
        let flat = floor(&seeds, &flips);
        let [u, v, w] = frame(up);
        let place = |x: f64, y: f64, z: f64| -> V3 {
            add(at, add(add(scaled(u, x), scaled(v, y)), scaled(w, z)))
        };
        let points = flat.points().iter().map(|p| place(p[0], p[1], p[2])).collect();
        let mesh = TriangleMesh::new(points, flat.triangles().to_vec()).unwrap();
        let (radius, sign) = (0.1, if below { -1.0 } else { 1.0 });
        let mut feature = None;
        // Along a path across the whole floor, over each of its inner points and along its sides.
        let path = (1..100).map(|k| [0.01 * f64::from(k), 0.05 + 0.9 * share * 0.01 * f64::from(k)]);
        let corners = flat.points().iter().skip(4).map(|p| [p[0], p[1]]);
        let sides = flat.triangles().iter().flat_map(|t| {
            let [a, b, c] = t.map(|k| flat.points()[k as usize]);
            [(a, b), (b, c), (c, a)].map(|(a, b)| [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])])
        });
        for [x, y] in path.chain(corners).chain(sides) {
            let touches = touched(&mesh, place(x, y, sign * (radius - depth)), radius);
            prop_assert_eq!(touches.len(), 1, "{} {} {:?}", x, y, touches);
            let touch = touches[0];
            let rim = x.min(y).min(1.0 - x).min(1.0 - y) < 1e-9;
            prop_assert!((touch.depth - depth).abs() < 1e-12, "{:e}", touch.depth - depth);
            prop_assert!((dot(touch.normal, w) - sign).abs() < 1e-12);
            let off = sub(touch.point, place(x, y, 0.0));
            prop_assert!(dot(off, off).sqrt() < 1e-12);
            // On the very rim the open sides and corners of the sheet are as near as its face.
            prop_assert!(rim || *feature.get_or_insert(touch.feature) == touch.feature);
        }
    }

    /// Around a convex body the touch is the nearest point of the box, whichever face, edge or corner that is.
    #[test]
    fn a_box_is_touched_at_its_nearest_point(
        size in prop::array::uniform3(0.1..2.0_f64), at in prop::array::uniform3(-0.3..1.3_f64), radius in 0.05..0.5_f64,
    ) {
        let mesh = closed_box([0.0; 3], size).unwrap();
        let centre: V3 = std::array::from_fn(|k| at[k] * size[k]);
        let nearest: V3 = std::array::from_fn(|k| centre[k].clamp(0.0, size[k]));
        let off = sub(centre, nearest);
        let distance = dot(off, off).sqrt();
        prop_assume!(distance > 1e-6 && (distance - radius).abs() > 1e-9);
        let touches = touched(&mesh, centre, radius);
        let outer: Vec<_> = touches.iter().filter(|touch| (touch.depth - (radius - distance)).abs() < 1e-12).collect();
        prop_assert_eq!(outer.len(), usize::from(distance < radius), "{:?}", touches);
        if let Some(touch) = outer.first() {
            prop_assert!((dot(touch.normal, off) - distance).abs() < 1e-12);
            let beyond = (0..3).filter(|&k| off[k] != 0.0).count();
            prop_assert_eq!(touch.feature.rank() as usize + 1, beyond);
        }
    }
}

/// A ridge of 90 degrees: over each face its plane, beyond the bisecting wedge the edge, at `r - |c|`.
#[test]
fn a_convex_edge_is_round() {
    let mesh = closed_box([-1.0; 3], [0.0, 1.0, 0.0]).unwrap();
    for k in 0..=900 {
        let angle = f64::from(k).to_radians() / 10.0;
        let centre = [0.1 * angle.sin(), 0.3, 0.1 * angle.cos()];
        let touches = touched(&mesh, centre, 0.11);
        assert_eq!(touches.len(), 1, "{k} {touches:?}");
        assert!((touches[0].depth - 0.01).abs() < 1e-15 * 10.0, "{k}: {}", touches[0].depth);
        if (1..900).contains(&k) {
            assert!(matches!(touches[0].feature, FeatureId::Edge(_)), "{k}");
        }
    }
    let corner = touched(&mesh, [0.06, 1.06, 0.06], 0.11);
    assert_eq!(corner.len(), 1);
    assert!(matches!(corner[0].feature, FeatureId::Corner(_)));
    assert!((corner[0].depth - (0.11 - 0.06 * 3.0_f64.sqrt())).abs() < 1e-15);
}

/// In a concave edge both walls are felt, in a concave corner all three; never the edge itself.
#[test]
fn concave_edges_and_corners_are_touched_by_each_wall() {
    let mesh = open_box([0.0; 3], [1.0; 3]).unwrap();
    let edge = touched(&mesh, [0.09, 0.5, 0.08], 0.1);
    assert_eq!(edge.len(), 2);
    assert!(edge.iter().all(|touch| matches!(touch.feature, FeatureId::Face(_))));
    let mut depths: Vec<f64> = edge.iter().map(|touch| touch.depth).collect();
    depths.sort_by(f64::total_cmp);
    assert!((depths[0] - 0.01).abs() < 1e-15 && (depths[1] - 0.02).abs() < 1e-15);
    let corner = touched(&mesh, [0.09, 0.91, 0.08], 0.1);
    assert_eq!(corner.len(), 3);
    assert!(corner.iter().all(|touch| matches!(touch.feature, FeatureId::Face(_))));
    // Between two walls, and nowhere.
    assert_eq!(touched(&open_box([0.0; 3], [0.2, 1.0, 1.0]).unwrap(), [0.1, 0.5, 0.5], 0.11).len(), 2);
    assert!(touched(&mesh, [0.5; 3], 0.4).is_empty());
}

/// A nearly flat valley and ridge: one touch, and no jump of depth beyond the rounding of the fold, whatever its angle up to
/// half a degree; the two sides differ in height by far less than the overlap where the touch changes hands.
#[test]
fn a_nearly_flat_fold_is_felt_once() {
    for degrees in [-0.5, -0.1, -1e-3, -1e-9, 1e-9, 1e-3, 0.1, 0.5_f64] {
        let slope = degrees.to_radians().tan();
        let left = rectangle([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]).unwrap();
        let right = rectangle([0.0; 3], [1.0, 0.0, slope], [0.0, 1.0, 0.0]).unwrap();
        let mesh = left.joined(&right).unwrap();
        let mut last: Option<f64> = None;
        for k in -1000..=1000 {
            let touches = touched(&mesh, [1e-5 * f64::from(k), 0.5, 0.0999], 0.1);
            assert_eq!(touches.len(), 1, "{degrees} {k}");
            // The centre moves 10 µm a step; the depth cannot change by more than the slope of that.
            let change = last.map_or(0.0, |last| (touches[0].depth - last).abs());
            assert!(change <= 1e-5 * slope.abs() + 1e-14, "{degrees} {k}: {change:e}");
            last = Some(touches[0].depth);
        }
    }
}

/// The open rim of a sheet is an edge: outside it the ball falls off round it.
#[test]
fn the_rim_of_a_sheet_is_round() {
    let mesh = rectangle([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]).unwrap();
    let touches = touched(&mesh, [-0.06, 0.5, 0.06], 0.1);
    assert_eq!(touches.len(), 1);
    assert!((touches[0].depth - (0.1 - 0.06 * 2.0_f64.sqrt())).abs() < 1e-15);
    assert!(matches!(touches[0].feature, FeatureId::Edge(_)));
    let nearest = (0..2).map(|triangle| mesh.distance_to(triangle, [-0.06, 0.5, 0.06])).fold(f64::INFINITY, f64::min);
    assert!((nearest - 0.06 * 2.0_f64.sqrt()).abs() < 1e-15);
}

/// A rim in pieces is one feature.
#[test]
fn pieces_of_a_straight_edge_are_one() {
    let piece = |k: f64| rectangle([k, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]).unwrap();
    let mesh = piece(0.0).joined(&piece(1.0)).unwrap().joined(&piece(2.0)).unwrap();
    let found: Vec<_> = (1..60).map(|k| touched(&mesh, [0.05 * f64::from(k), -0.06, 0.06], 0.1)).collect();
    assert!(found.iter().all(|touches| touches.len() == 1 && touches[0].feature == found[0][0].feature));
}
