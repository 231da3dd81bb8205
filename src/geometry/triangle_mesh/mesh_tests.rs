use super::*;
use crate::geometry::triangle_mesh::closed_box;

const SQUARE: [V3; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

fn says(points: &[V3], triangles: &[[u32; 3]]) -> String {
    TriangleMesh::new(points.to_vec(), triangles.to_vec()).unwrap_err().to_string()
}

#[test]
fn what_is_wrong_with_a_mesh_is_named() {
    assert_eq!(says(&SQUARE, &[]), "the mesh has no triangles");
    assert_eq!(
        says(&SQUARE, &[[0, 1, 2], [0, 2, 4]]),
        "triangle 1 of the mesh names point 4, and there are 4 (counted from 0)"
    );
    let mut points = SQUARE;
    points[2][1] = f64::NAN;
    assert_eq!(says(&points, &[[0, 1, 3]]), "point 2 of the mesh lies at (1, NaN, 0), which is not a place");
    points[2] = [2.0, 0.0, 0.0];
    assert!(says(&points, &[[0, 1, 2]]).starts_with(
        "triangle 0 of the mesh has no area: its corners are (0, 0, 0) m, (1, 0, 0) m and (2, 0, 0) m\n\nhint: "
    ));
    assert!(says(&SQUARE, &[[0, 1, 1]]).starts_with("triangle 0 of the mesh has no area"));
    let millimetres = SQUARE.map(|point| scaled(point, 2500.0));
    assert!(says(&millimetres, &[[0, 1, 2]]).contains("the mesh is 2500 m wide"));
    assert!(says(&millimetres, &[[0, 1, 2]]).contains("hint: are its coordinates in millimetres?"));
    let kilometres = SQUARE.map(|point| scaled(point, 2.5e-5));
    assert!(says(&kilometres, &[[0, 1, 2]]).starts_with("the mesh is only 0.025 mm wide\n\nhint: "));
}

#[test]
fn closed_means_two_triangles_a_side_that_face_the_same_way() {
    let block = closed_box([0.0; 3], [1.0; 3]).unwrap();
    let mut triangles = block.triangles().to_vec();
    let removed = triangles.pop().unwrap();
    let open = TriangleMesh::new(block.points().to_vec(), triangles.clone()).unwrap();
    assert!(matches!(open.check_closed(), Err(MeshError::Open { open: 3, .. })));
    triangles.push([removed[1], removed[0], removed[2]]);
    let turned = TriangleMesh::new(block.points().to_vec(), triangles.clone()).unwrap();
    assert!(matches!(turned.check_closed(), Err(MeshError::Turned { .. })));
    triangles.push(removed);
    let branched = TriangleMesh::new(block.points().to_vec(), triangles).unwrap();
    assert!(matches!(
        branched.check_closed(),
        Err(MeshError::Branched { triangles: 3, .. } | MeshError::Turned { .. })
    ));
}

/// Joined, moved and scaled bodies keep area, volume and the names of their patches.
#[test]
fn bodies_can_be_joined_moved_and_scaled() {
    let block = closed_box([0.0; 3], [1.0, 2.0, 3.0]).unwrap();
    let other = block.moved([5.0, 0.0, 0.0]).unwrap().named("other");
    let both = block.joined(&other).unwrap();
    both.check_closed().unwrap();
    assert!((both.volume() - 12.0).abs() < 1e-12);
    assert_eq!(both.patches().last().unwrap(), "other");
    assert_eq!((both.patch(0), both.patch(23)), ("x-low", "other"));
    assert_eq!(both.bounds(), [[0.0; 3], [6.0, 2.0, 3.0]]);
    let small = block.scaled(0.1).unwrap();
    assert!((small.volume() - 0.006).abs() < 1e-15);
    assert!(block.moved([f64::INFINITY, 0.0, 0.0]).is_err());
}

#[test]
fn a_mesh_reads_back_from_its_text() {
    let mesh = closed_box([0.1; 3], [1.0, 2.0, 3.0]).unwrap();
    let text = serde_json::to_string(&mesh).unwrap();
    assert_eq!(serde_json::from_str::<TriangleMesh>(&text).unwrap(), mesh);
    let wrong = serde_json::from_str::<TriangleMesh>(&text.replace("[0.1,0.1,0.1]", "[0.1,0.1,1e999]"));
    assert!(wrong.is_err());
}
