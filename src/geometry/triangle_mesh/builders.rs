//! Meshes of the bodies that tests with ballast need.

use crate::units::Metres;

use super::error::MeshError;
use super::mesh::TriangleMesh;
use super::vector::{V3, add};

/// A parallelogram from `corner` along `u` and `v`, m, as one sheet of two triangles that faces `u × v`; patch `surface`.
///
/// # Errors
/// When `u` and `v` span no area.
pub fn rectangle(corner: V3, u: V3, v: V3) -> Result<TriangleMesh, MeshError> {
    of_quads(&[("surface", [corner, add(corner, u), add(add(corner, u), v), add(corner, v)])])
}

/// A closed box, facing outwards; patches `x-low`, `x-high`, `y-low`, `y-high`, `bottom`, `top`.
///
/// # Errors
/// When `high` is not above `low` in every direction.
pub fn closed_box(low: V3, high: V3) -> Result<TriangleMesh, MeshError> {
    let names = ["x-low", "x-high", "y-low", "y-high", "bottom", "top"];
    of_quads(&box_sides(low, high, names)?)
}

/// A box without a lid; patches as those of [`closed_box`] but `top`.
///
/// # Errors
/// As [`closed_box`].
pub fn open_box(low: V3, high: V3) -> Result<TriangleMesh, MeshError> {
    let names = ["x-low", "x-high", "y-low", "y-high", "bottom", "top"];
    of_quads(&box_sides(low, high, names)?[..5])
}

/// A sleeper that lies along x, to be pushed towards +x: `bottom`, `top`, `shoulder` (the end at high x), `far-end` (the end at
/// low x) and `crib` (both long sides).
///
/// # Errors
/// As [`closed_box`].
pub fn sleeper_block(low: V3, high: V3) -> Result<TriangleMesh, MeshError> {
    of_quads(&box_sides(low, high, ["far-end", "shoulder", "crib", "crib", "bottom", "top"])?)
}

/// A square funnel around the vertical through (`axis[0]`, `axis[1]`): `opening` wide at the height `axis[2]`, `top` wide at
/// `height` above it; patch `walls`, and with a gate a lid under the opening, patch `gate`.
///
/// # Errors
/// When a length is none, or the funnel does not narrow.
pub fn square_hopper(
    axis: V3,
    opening: Metres,
    top: Metres,
    height: Metres,
    gate: bool,
) -> Result<TriangleMesh, MeshError> {
    positive("opening of the hopper", opening)?;
    positive("top of the hopper", top)?;
    if top.si() <= opening.si() {
        return Err(MeshError::NoFunnel { top, opening });
    }
    positive("height of the hopper", height)?;
    let ring = |width: f64, z: f64| -> [V3; 4] {
        let half = 0.5 * width;
        [[-half, -half, z], [half, -half, z], [half, half, z], [-half, half, z]].map(|corner| add(corner, axis))
    };
    let (low, high) = (ring(opening.si(), 0.0), ring(top.si(), height.si()));
    let mut quads: Vec<_> = (0..4)
        .map(|k| {
            let next = (k + 1) % 4;
            ("walls", [low[next], low[k], high[k], high[next]])
        })
        .collect();
    if gate {
        quads.push(("gate", low));
    }
    of_quads(&quads)
}

/// A closed prism like the shoulder of a bed: from the vertical plane x = 0 a crest of width `crest` at `height`, then a slope of
/// `run` to one down to z = 0 (1.5 for ballast); `length` along y; patches `back`, `crest`, `slope`, `bottom`, `ends`.
///
/// # Errors
/// When a length is none.
pub fn shoulder_prism(crest: Metres, height: Metres, length: Metres, run: f64) -> Result<TriangleMesh, MeshError> {
    positive("crest of the shoulder", crest)?;
    positive("height of the shoulder", height)?;
    positive("length of the shoulder", length)?;
    positive("run of the slope on one metre of rise", Metres(run))?;
    let (crest, h, toe) = (crest.si(), height.si(), crest.si() + run * height.si());
    let at = |y: f64| [[0.0, y, 0.0], [toe, y, 0.0], [crest, y, h], [0.0, y, h]];
    let (near, far) = (at(0.0), at(length.si()));
    let side = |k: usize| {
        let next = (k + 1) % 4;
        [near[next], near[k], far[k], far[next]]
    };
    of_quads(&[
        ("bottom", side(0)),
        ("slope", side(1)),
        ("crest", side(2)),
        ("back", side(3)),
        ("ends", near),
        ("ends", [far[3], far[2], far[1], far[0]]),
    ])
}

/// The sides of a box in the order of `names`: low and high x, low and high y, bottom, top; all face outwards.
fn box_sides(low: V3, high: V3, names: [&str; 6]) -> Result<[(&str, [V3; 4]); 6], MeshError> {
    for (axis, what) in ["width of the box", "depth of the box", "height of the box"].into_iter().enumerate() {
        positive(what, Metres(high[axis] - low[axis]))?;
    }
    let at = |x: usize, y: usize, z: usize| [[low, high][x][0], [low, high][y][1], [low, high][z][2]];
    let sides = [
        [at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)],
        [at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)],
        [at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)],
        [at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0)],
        [at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0)],
        [at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)],
    ];
    Ok(std::array::from_fn(|k| (names[k], sides[k])))
}

fn of_quads(quads: &[(&str, [V3; 4])]) -> Result<TriangleMesh, MeshError> {
    let corners: Vec<_> = quads.iter().flat_map(|(_, [a, b, c, d])| [[*a, *b, *c], [*a, *c, *d]]).collect();
    Ok(TriangleMesh::from_soup(&corners)?.with_patches(|triangle| quads[triangle / 2].0.to_owned()))
}

fn positive(what: &'static str, value: Metres) -> Result<(), MeshError> {
    let good = value.si() > 0.0 && value.si().is_finite();
    if good { Ok(()) } else { Err(MeshError::NotALength { what, value }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: f64, exact: f64) {
        assert!((found - exact).abs() < 1e-12 * exact.abs().max(1.0), "{found} {exact}");
    }

    /// Volumes and areas by hand; a positive volume says that all sides face outwards.
    #[test]
    fn bodies_are_closed_and_face_outwards() {
        let block = closed_box([0.0; 3], [2.0, 3.0, 0.5]).unwrap();
        block.check_closed().unwrap();
        close(block.volume(), 3.0);
        close(block.area(), 2.0 * (6.0 + 1.0 + 1.5));
        let sleeper = sleeper_block([-1.25, -0.13, 0.0], [1.25, 0.13, 0.2]).unwrap();
        sleeper.check_closed().unwrap();
        close(sleeper.volume(), 2.5 * 0.26 * 0.2);
        assert_eq!(sleeper.patches(), ["far-end", "shoulder", "crib", "bottom", "top"]);
        let area = |name: &str| {
            let own = (0..12).filter(|&triangle| sleeper.patch(triangle) == name);
            let corners: Vec<_> = own.map(|triangle| sleeper.corners(triangle)).collect();
            TriangleMesh::from_soup(&corners).unwrap().area()
        };
        close(area("shoulder"), 0.26 * 0.2);
        close(area("crib"), 2.0 * 2.5 * 0.2);
        close(area("bottom"), 2.5 * 0.26);
        // A trapezium of 0.4 m and 1.0 m over a height of 0.4 m, 2 m long.
        let shoulder = shoulder_prism(Metres(0.4), Metres(0.4), Metres(2.0), 1.5).unwrap();
        shoulder.check_closed().unwrap();
        close(shoulder.volume(), 0.5 * (0.4 + 1.0) * 0.4 * 2.0);
    }

    #[test]
    fn sheets_are_open() {
        close(rectangle([0.0; 3], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0]).unwrap().area(), 6.0);
        let tray = open_box([0.0; 3], [1.0; 3]).unwrap();
        close(tray.area(), 5.0);
        let message = tray.check_closed().unwrap_err().to_string();
        assert!(
            message.starts_with("the mesh is open where a closed one is needed: the edge from point "),
            "{message}"
        );
        assert!(message.contains("at (0, 0, 1) m") && message.contains("(4 such edges)"), "{message}");
        // Four trapezia of slant height s: s² = 0.65² + 0.375².
        let hopper = square_hopper([0.0, 0.0, 0.7], Metres(0.25), Metres(1.0), Metres(0.65), true).unwrap();
        close(hopper.area(), 4.0 * 0.5 * 1.25 * 0.65_f64.hypot(0.375) + 0.0625);
        assert_eq!(hopper.patches(), ["walls", "gate"]);
        assert_eq!(hopper.bounds(), [[-0.5, -0.5, 0.7], [0.5, 0.5, 0.7 + 0.65]]);
    }

    #[test]
    fn lengths_that_are_none_are_refused() {
        let says = |found: Result<TriangleMesh, MeshError>| found.unwrap_err().to_string();
        assert_eq!(
            says(closed_box([0.0; 3], [1.0, 0.0, 1.0])),
            "the depth of the box of 0 m is not a length to build with: it must be above 0 m and finite"
        );
        assert!(says(closed_box([0.0; 3], [f64::NAN, 1.0, 1.0])).starts_with("the width of the box of NaN m"));
        let upside_down = square_hopper([0.0; 3], Metres(1.0), Metres(0.25), Metres(1.0), false);
        assert!(says(upside_down).starts_with("a hopper of 0.25 m at the top and 1 m at its opening does not narrow"));
        assert!(
            says(shoulder_prism(Metres(0.4), Metres(0.4), Metres(-1.0), 1.5)).starts_with("the length of the shoulder")
        );
    }
}
