//! What is wrong with a mesh of triangles.

use crate::units::Metres;

/// Why a mesh was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// Nothing in it.
    #[error("the mesh has no triangles")]
    Empty,
    /// A coordinate that is not a number, or not finite.
    #[error("point {point} of the mesh lies at ({}, {}, {}), which is not a place", at[0], at[1], at[2])]
    NotAPlace {
        /// Index of the point, from 0.
        point: usize,
        /// Its coordinates, m.
        at: [f64; 3],
    },
    /// A triangle that names a point that is not there.
    #[error("triangle {triangle} of the mesh names point {index}, and there are {points} (counted from 0)")]
    NoSuchPoint {
        /// Index of the triangle, from 0.
        triangle: usize,
        /// The index it names.
        index: u32,
        /// How many points there are.
        points: usize,
    },
    /// A triangle without an area.
    #[error(
        "triangle {triangle} of the mesh has no area: its corners are {}, {} and {}\n\nhint: remove it, or clean the mesh in the program that made it",
        place(&corners[0]), place(&corners[1]), place(&corners[2])
    )]
    NoArea {
        /// Index of the triangle, from 0.
        triangle: usize,
        /// Its corners, m.
        corners: [[f64; 3]; 3],
    },
    /// A mesh with a hole where a closed one is needed.
    #[error(
        "the mesh is open where a closed one is needed: the edge from point {} at {} to point {} at {} has a triangle on one side only ({open} such edges)\n\nhint: close the hole, or use the mesh where a sheet will do (walls, gates, hoppers)",
        edge[0], place(&ends[0]), edge[1], place(&ends[1])
    )]
    Open {
        /// Indices of the two points.
        edge: [u32; 2],
        /// Where they are, m.
        ends: [[f64; 3]; 2],
        /// How many edges are open in all.
        open: usize,
    },
    /// Three or more triangles at an edge where a closed surface has two.
    #[error(
        "the edge from point {} at {} to point {} at {} has {triangles} triangles; a closed surface has two\n\nhint: split the mesh into bodies that do not share edges",
        edge[0], place(&ends[0]), edge[1], place(&ends[1])
    )]
    Branched {
        /// Indices of the two points.
        edge: [u32; 2],
        /// Where they are, m.
        ends: [[f64; 3]; 2],
        /// How many triangles meet there.
        triangles: usize,
    },
    /// Two neighbours that do not face the same way.
    #[error(
        "the triangles {} and {} at the edge from {} to {} face opposite ways\n\nhint: turn one of them round (exchange two of its points)",
        triangles[0], triangles[1], place(&ends[0]), place(&ends[1])
    )]
    Turned {
        /// The two triangles.
        triangles: [usize; 2],
        /// Ends of their common edge, m.
        ends: [[f64; 3]; 2],
    },
    /// A mesh so wide that it is likely in other units.
    #[error(
        "the mesh is {} m wide, and walls of ballast tests are below {limit}\n\nhint: are its coordinates in millimetres? This program reads metres: scale the mesh by 0.001",
        width.si()
    )]
    TooWide {
        /// Its widest extent.
        width: Metres,
        /// The limit.
        limit: Metres,
    },
    /// A mesh so small that it is likely in other units.
    #[error(
        "the mesh is only {} wide\n\nhint: are its coordinates in kilometres or inches? This program reads metres: scale the mesh",
        width.in_unit("mm")
    )]
    TooNarrow {
        /// Its widest extent.
        width: Metres,
    },
    /// A length of a builder that is not one.
    #[error("the {what} of {value} is not a length to build with: it must be above 0 m and finite")]
    NotALength {
        /// `width of the hopper`, …
        what: &'static str,
        /// What was asked for.
        value: Metres,
    },
    /// A hopper that widens downwards.
    #[error(
        "a hopper of {top} at the top and {opening} at its opening does not narrow\n\nhint: make the top wider than the opening"
    )]
    NoFunnel {
        /// Width at the top.
        top: Metres,
        /// Width of the opening.
        opening: Metres,
    },
    /// An STL file that ends too early, or whose text cannot be read.
    #[error(
        "not an STL mesh: {what} at {place}\n\nhint: STL is either text that begins with `solid`, or 80 bytes, a count and 50 bytes for each triangle"
    )]
    Stl {
        /// What was found.
        what: &'static str,
        /// `line 12` or `byte 84`.
        place: String,
    },
}

/// A place as messages show it.
fn place(at: &[f64; 3]) -> String {
    let round = |v: f64| (v * 1e6).round() / 1e6;
    format!("({}, {}, {}) m", round(at[0]), round(at[1]), round(at[2]))
}
