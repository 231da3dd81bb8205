//! CSV and JSON, written and read back.

use std::fmt::Write as _;
use std::str::FromStr;

use crate::geometry::Disc;
use crate::packing::bed::{FORMAT_VERSION, Packing};
use crate::packing::error::PackingError;
use crate::units::Metres;

/// How deep two stones of a file may overlap: 1 µm, what six decimals of a metre can hide.
pub const OVERLAP_TOLERANCE: Metres = Metres(1e-6);

const HEADER: [&str; 3] = ["x", "y", "radius"];

/// Writes `x,y,radius` in metres, below comments with the domain, the generator and the seed.
pub fn csv(packing: &Packing) -> String {
    let mut text = format!("# generator = {}\n", packing.generator);
    // Writing to a String cannot fail.
    if let Some(seed) = packing.seed {
        let _ = writeln!(text, "# seed = {seed}");
    }
    let _ = writeln!(text, "# width = {}\n# height = {}\nx,y,radius", packing.width, packing.height);
    for disc in &packing.discs {
        let _ = writeln!(text, "{},{},{}", disc.x, disc.y, disc.radius);
    }
    text
}

/// Reads stones from CSV: the header `x,y,radius`, metres, `#` comments.
///
/// The domain is `domain` when given, else what the comments `# width = 1.5 m` and `# height = 0.48 m` say, else the
/// rectangle from the origin that just holds the stones.
///
/// # Errors
/// A line that cannot be read, no stones, a stone outside the domain, two stones that overlap by more than `tolerance`
/// ([`OVERLAP_TOLERANCE`] is a good one).
pub fn from_csv(text: &str, domain: Option<(Metres, Metres)>, tolerance: Metres) -> Result<Packing, PackingError> {
    let mut packing = Packing::new("file", None, (Metres(0.0), Metres(0.0)), Vec::new());
    let (mut width, mut height) = (None, None);
    let mut header_seen = false;
    for (number, line) in (1_u64..).zip(text.trim_start_matches('\u{feff}').lines()) {
        let line = line.trim();
        if line.is_empty() {
            continue;
        }
        let bad_row = |hint| PackingError::BadRow { line: number, text: line.into(), hint };
        if let Some(comment) = line.strip_prefix('#') {
            let Some((key, value)) = comment.split_once('=') else { continue };
            let length = || value.trim().parse::<Metres>().map_err(|_| bad_row("write the length as `1.5 m`"));
            match key.trim() {
                "generator" => packing.generator = value.trim().into(),
                "seed" => packing.seed = Some(value.trim().parse().map_err(|_| bad_row("a seed is a whole number"))?),
                "width" => width = Some(length()?),
                "height" => height = Some(length()?),
                _ => {}
            }
        } else if !header_seen {
            if line.split(',').map(str::trim).ne(HEADER) {
                return Err(bad_row("the first line must be the header `x,y,radius`"));
            }
            header_seen = true;
        } else {
            packing.discs.push(stone(line).ok_or_else(|| bad_row("write x,y,radius in metres: `0.75,0.031,0.0225`"))?);
        }
    }
    let right = packing.discs.iter().map(|disc| disc.x + disc.radius).fold(0.0, f64::max);
    let (width, height) = match domain {
        Some((width, height)) => (Some(width), Some(height)),
        None => (width, height),
    };
    packing.width = width.unwrap_or(Metres(right));
    packing.height = height.unwrap_or(packing.top());
    if packing.discs.is_empty() {
        return Err(PackingError::Empty);
    }
    packing.checked(tolerance)
}

fn stone(line: &str) -> Option<Disc> {
    let numbers: Vec<f64> = line
        .split(',')
        .map(|field| field.trim().parse::<f64>().ok().filter(|value| value.is_finite()))
        .collect::<Option<_>>()?;
    let [x, y, radius] = numbers[..] else { return None };
    Some(Disc { x, y, radius })
}

/// Writes a packing as JSON with its format version.
///
/// # Errors
/// A number that JSON cannot hold (not a number, infinite) is written as null and refused on reading; nothing else.
pub fn json(packing: &Packing) -> Result<String, PackingError> {
    serde_json::to_string(packing)
        .map(|text| text + "\n")
        .map_err(|error| PackingError::BadJson { reason: error.to_string() })
}

/// Reads a packing from JSON.
///
/// # Errors
/// What is not such JSON, a later format version, stones outside the domain or overlapping by more than `tolerance`.
pub fn from_json(text: &str, tolerance: Metres) -> Result<Packing, PackingError> {
    #[derive(serde::Deserialize)]
    struct Version {
        format_version: u32,
    }
    #[derive(serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Stone {
        x: Exact<f64>,
        y: Exact<f64>,
        radius: Exact<f64>,
    }
    #[derive(serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Stones {
        format_version: Exact<u32>,
        generator: String,
        #[serde(default)]
        seed: Option<Exact<u64>>,
        width: Metres,
        height: Metres,
        discs: Vec<Stone>,
    }
    let bad_json = |error: serde_json::Error| PackingError::BadJson { reason: error.to_string() };
    let Version { format_version: found } = serde_json::from_str(text).map_err(bad_json)?;
    if found != FORMAT_VERSION {
        return Err(PackingError::FormatVersion { found, known: FORMAT_VERSION });
    }
    let read: Stones = serde_json::from_str(&quote_numbers(text)).map_err(bad_json)?;
    let discs = read.discs.iter().map(|s| Disc { x: s.x.0, y: s.y.0, radius: s.radius.0 }).collect();
    let packing = Packing {
        format_version: read.format_version.0,
        generator: read.generator,
        seed: read.seed.map(|seed| seed.0),
        width: read.width,
        height: read.height,
        discs,
    };
    packing.checked(tolerance)
}

/// A number read from its digits by the standard library, which rounds correctly.
///
/// `serde_json` without its feature `float_roundtrip` is off by one unit in the last place now and then; then a packing
/// that was saved would not be the packing that was made.
struct Exact<T>(T);

impl<'de, T: FromStr> serde::Deserialize<'de> for Exact<T> {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let digits = std::borrow::Cow::<str>::deserialize(deserializer)?;
        digits.parse().map(Self).map_err(|_| serde::de::Error::custom(format_args!("`{digits}` is not such a number")))
    }
}

/// Puts every number of a JSON text that stands outside a string into quotes.
fn quote_numbers(text: &str) -> String {
    let mut quoted = String::with_capacity(text.len() + text.len() / 8);
    let (mut in_string, mut escaped, mut in_number) = (false, false, false);
    for c in text.chars() {
        let part_of_number =
            c.is_ascii_digit() || matches!(c, '-' | '+' | '.') || (in_number && matches!(c, 'e' | 'E'));
        if !in_string && part_of_number != in_number {
            quoted.push('"');
            in_number = part_of_number;
        }
        quoted.push(c);
        if c == '"' && !escaped {
            in_string = !in_string;
        }
        escaped = in_string && c == '\\' && !escaped;
    }
    quoted
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packing::{RsaInput, pack};

    fn tank() -> Packing {
        pack(&RsaInput::benedetto2018().unwrap(), 11).unwrap().after
    }

    #[test]
    fn csv_comes_back_to_the_same_bits() {
        assert_eq!(from_csv(&csv(&tank()), None, OVERLAP_TOLERANCE).unwrap(), tank());
    }

    #[test]
    fn json_comes_back_to_the_same_bits() {
        for seed in 0..20 {
            let packing = pack(&RsaInput::benedetto2018().unwrap(), seed).unwrap().after;
            let read = from_json(&json(&packing).unwrap(), OVERLAP_TOLERANCE).unwrap();
            assert!(read == packing, "seed {seed}");
        }
    }

    #[test]
    fn numbers_are_quoted_and_strings_left_alone() {
        assert_eq!(quote_numbers(r#"{"a1":-1.5e-3,"b\"2":[3,"4 m"]}"#), r#"{"a1":"-1.5e-3","b\"2":["3","4 m"]}"#);
    }

    #[test]
    fn a_bare_table_gets_the_rectangle_that_holds_it() {
        let packing = from_csv("x,y,radius\n0.1,0.1,0.05\n0.3,0.1,0.04\n", None, OVERLAP_TOLERANCE).unwrap();
        assert!((packing.width.si() - 0.34).abs() < 1e-15 && (packing.height.si() - 0.15).abs() < 1e-15);
        let domain = Some((Metres(0.5), Metres(0.2)));
        let packing = from_csv("x,y,radius\n0.1,0.1,0.05\n", domain, OVERLAP_TOLERANCE).unwrap();
        assert_eq!((packing.width, packing.height), (Metres(0.5), Metres(0.2)));
    }

    #[test]
    fn what_cannot_be_read_is_named() {
        let error = |text: &str| from_csv(text, None, OVERLAP_TOLERANCE).unwrap_err().to_string();
        assert_eq!(
            error("x,y,radius\n0.1,0.1\n"),
            "line 2 of the packing is `0.1,0.1`, not a stone\n\nhint: write x,y,radius in metres: `0.75,0.031,0.0225`"
        );
        assert_eq!(
            error("0.1,0.1,0.05\n"),
            "line 1 of the packing is `0.1,0.1,0.05`, not a stone\n\nhint: the first line must be the header `x,y,radius`"
        );
        assert!(error("x,y,radius\n0.1,nan,0.05\n").starts_with("line 2 "));
        assert!(error("x,y,radius\n").starts_with("the packing holds no stones"));
        assert!(error("x,y,radius\n0.1,0.1,-0.05\n").starts_with("the radius of a stone of -0.05 m is not a length"));
        assert_eq!(
            error("x,y,radius\n0.125,0.125,0.0625\n0.1875,0.125,0.0625\n"),
            "stones 1 and 2 overlap by 62.5 mm, more than the 0.001 mm allowed\n\nhint: stones are counted from 1 in the order of the file"
        );
        let later = json(&tank()).unwrap().replace("\"format_version\":1", "\"format_version\":2");
        assert_eq!(
            from_json(&later, OVERLAP_TOLERANCE).unwrap_err().to_string(),
            "the packing has format version 2, and this program reads 1"
        );
        assert!(from_json("{}", OVERLAP_TOLERANCE).unwrap_err().to_string().contains("missing field `format_version`"));
    }
}
