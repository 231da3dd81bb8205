//! Beds of spheres as CSV and JSON, written and read back, and the reader of either kind of packing.

use std::fmt::Write as _;

use crate::geometry::Sphere;
use crate::packing::bed::{FORMAT_VERSION, Packing};
use crate::packing::error::PackingError;
use crate::packing::spheres::SphereBed;
use crate::units::Metres;

use super::table::from_json;

const HEADER: [&str; 4] = ["x", "y", "z", "radius"];

/// What a packing file holds.
#[derive(Debug, Clone, PartialEq)]
pub enum Particles {
    /// Discs in a rectangle.
    Plane(Packing),
    /// Spheres in a box.
    Space(SphereBed),
}

/// Reads a packing of either kind from JSON: one with `spheres` is a bed in space, any other one of discs.
///
/// # Errors
/// What is not such JSON, a later format version, stones outside the domain or overlapping by more than `tolerance`.
pub fn particles_from_json(text: &str, tolerance: Metres) -> Result<Particles, PackingError> {
    #[derive(serde::Deserialize)]
    struct Head {
        format_version: u32,
        spheres: Option<serde::de::IgnoredAny>,
    }
    let bad_json = |error: serde_json::Error| PackingError::BadJson { reason: error.to_string() };
    let Head { format_version: found, spheres } = serde_json::from_str(text).map_err(bad_json)?;
    if spheres.is_none() {
        return from_json(text, tolerance).map(Particles::Plane);
    }
    if found != FORMAT_VERSION {
        return Err(PackingError::FormatVersion { found, known: FORMAT_VERSION });
    }
    let bed: SphereBed = serde_json::from_str(text).map_err(bad_json)?;
    bed.checked(tolerance).map(Particles::Space)
}

/// Writes a bed of spheres as JSON with its format version.
///
/// # Errors
/// As [`json`](super::json).
pub fn spheres_json(bed: &SphereBed) -> Result<String, PackingError> {
    serde_json::to_string(bed)
        .map(|text| text + "\n")
        .map_err(|error| PackingError::BadJson { reason: error.to_string() })
}

/// Writes `x,y,z,radius` in metres, below comments with the box, the generator and the seed.
pub fn spheres_csv(bed: &SphereBed) -> String {
    let mut text = format!("# generator = {}\n", bed.generator);
    // Writing to a String cannot fail.
    if let Some(seed) = bed.seed {
        let _ = writeln!(text, "# seed = {seed}");
    }
    for (name, length) in ["length", "width", "height"].into_iter().zip(bed.size) {
        let _ = writeln!(text, "# {name} = {length}");
    }
    let _ = writeln!(text, "x,y,z,radius");
    for Sphere { centre: [x, y, z], radius } in &bed.spheres {
        let _ = writeln!(text, "{x},{y},{z},{radius}");
    }
    text
}

/// Reads spheres from CSV: the header `x,y,z,radius`, metres, `#` comments. The box is what the comments `# length`,
/// `# width` and `# height` say, else the box from the origin that just holds the stones.
///
/// # Errors
/// A line that cannot be read, no stones, a stone outside the box, two stones that overlap by more than `tolerance`.
pub fn spheres_from_csv(text: &str, tolerance: Metres) -> Result<SphereBed, PackingError> {
    let mut bed = SphereBed::new("file", None, [Metres(0.0); 3], Vec::new());
    let mut size = [None; 3];
    let mut header_seen = false;
    for (number, line) in (1_u64..).zip(text.trim_start_matches('\u{feff}').lines()) {
        let line = line.trim();
        if line.is_empty() {
            continue;
        }
        let bad_row = |hint| PackingError::BadRow { line: number, text: line.into(), hint };
        if let Some(comment) = line.strip_prefix('#') {
            let Some((key, value)) = comment.split_once('=') else { continue };
            let (key, value) = (key.trim(), value.trim());
            match key {
                "generator" => bed.generator = value.into(),
                "seed" => bed.seed = Some(value.parse().map_err(|_| bad_row("a seed is a whole number"))?),
                _ => {
                    if let Some(axis) = ["length", "width", "height"].iter().position(|name| *name == key) {
                        size[axis] = Some(value.parse().map_err(|_| bad_row("write the length as `1.5 m`"))?);
                    }
                }
            }
        } else if !header_seen {
            if line.split(',').map(str::trim).ne(HEADER) {
                return Err(bad_row("the first line must be the header `x,y,z,radius`"));
            }
            header_seen = true;
        } else {
            let fields: Option<Vec<f64>> =
                line.split(',').map(|field| field.trim().parse::<f64>().ok().filter(|v| v.is_finite())).collect();
            let Some([x, y, z, radius]) = fields.as_deref() else {
                return Err(bad_row("write x,y,z,radius in metres: `0.75,0.2,0.031,0.0225`"));
            };
            bed.spheres.push(Sphere { centre: [*x, *y, *z], radius: *radius });
        }
    }
    if bed.spheres.is_empty() {
        return Err(PackingError::Empty);
    }
    bed.size = std::array::from_fn(|axis| {
        let far = bed.spheres.iter().map(|sphere| sphere.centre[axis] + sphere.radius).fold(0.0, f64::max);
        size[axis].unwrap_or(Metres(far))
    });
    bed.checked(tolerance)
}

/// Whether a CSV text is one of spheres: its header has a `z`.
pub fn is_csv_of_spheres(text: &str) -> bool {
    let header = text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with('#'));
    header.is_some_and(|line| line.trim_start_matches('\u{feff}').split(',').any(|name| name.trim() == "z"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packing::export::{OVERLAP_TOLERANCE, json};
    use crate::packing::spheres::{RandomAddition, SphereContact, random_addition};
    use crate::packing::{ClassReading, Grading, RsaInput, pack};
    use crate::units::Share;

    fn bed() -> SphereBed {
        let input = RandomAddition {
            size: [Metres(0.4), Metres(0.3), Metres(0.3)],
            periodic: [false; 2],
            grading: Grading::benedetto2018().unwrap(),
            class_reading: ClassReading::En933,
            solid_share: Share(0.25),
        };
        random_addition(&input, 7).unwrap()
    }

    #[test]
    fn json_and_csv_come_back_to_the_same_bits() {
        let mut bed = bed();
        assert_eq!(spheres_from_csv(&spheres_csv(&bed), OVERLAP_TOLERANCE).unwrap(), bed);
        bed.periodic = [true, false];
        bed.contacts.push(SphereContact { first: 1, second: 0, normal_force: 0.1 + 0.2 });
        let read = particles_from_json(&spheres_json(&bed).unwrap(), OVERLAP_TOLERANCE).unwrap();
        assert_eq!(read, Particles::Space(bed));
    }

    /// One reader takes both kinds, and files of discs are read as ever.
    #[test]
    fn discs_are_read_as_discs() {
        let discs = pack(&RsaInput::benedetto2018().unwrap(), 3).unwrap().after;
        let read = particles_from_json(&json(&discs).unwrap(), OVERLAP_TOLERANCE).unwrap();
        assert_eq!(read, Particles::Plane(discs));
        assert!(is_csv_of_spheres("# a = b\n\nx,y,z,radius\n") && !is_csv_of_spheres("x,y,radius\n0,0,1\n"));
    }

    #[test]
    fn what_cannot_be_read_is_named() {
        let error = |text: &str| spheres_from_csv(text, OVERLAP_TOLERANCE).unwrap_err().to_string();
        assert_eq!(
            error("x,y,z,radius\n0.1,0.1,0.1\n"),
            "line 2 of the packing is `0.1,0.1,0.1`, not a stone\n\nhint: write x,y,z,radius in metres: `0.75,0.2,0.031,0.0225`"
        );
        assert!(error("x,y,radius\n").contains("the first line must be the header `x,y,z,radius`"));
        assert!(error("x,y,z,radius\n").starts_with("the packing holds no stones"));
        assert!(error("x,y,z,radius\n0.1,0.1,0.1,0\n").starts_with("the radius of a stone of 0 m is not a length"));
        let later = spheres_json(&bed()).unwrap().replace("\"format_version\":1", "\"format_version\":2");
        assert_eq!(
            particles_from_json(&later, OVERLAP_TOLERANCE).unwrap_err().to_string(),
            "the packing has format version 2, and this program reads 1"
        );
    }
}
