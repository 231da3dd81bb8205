//! Gradings as users write them: CSV and TOML.

use serde::{Deserialize, Deserializer, Serialize, de};

use crate::units::{Metres, Share};

use super::curve::{Confidence, Grading, Sieve};
use super::error::GradingError;

/// A grading as it stands in a file, not checked yet.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GradingTable {
    #[serde(default = "your_own")]
    name: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    confidence: Option<Confidence>,
    sieve: Vec<Sieve>,
}

fn your_own() -> String {
    "own curve".into()
}

impl From<Grading> for GradingTable {
    fn from(grading: Grading) -> Self {
        Self { name: grading.name().into(), confidence: grading.confidence(), sieve: grading.sieves().to_vec() }
    }
}

impl TryFrom<GradingTable> for Grading {
    type Error = GradingError;
    fn try_from(table: GradingTable) -> Result<Self, GradingError> {
        Ok(Self::new(table.name, table.sieve)?.with_confidence(table.confidence))
    }
}

impl<'de> Deserialize<'de> for Grading {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NameOrTable;
        impl<'de> de::Visitor<'de> for NameOrTable {
            type Value = Grading;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("the name of a grading, or a table with [[sieve]] rows")
            }
            fn visit_str<E: de::Error>(self, name: &str) -> Result<Grading, E> {
                Grading::named(name).map_err(E::custom)
            }
            fn visit_map<A: de::MapAccess<'de>>(self, map: A) -> Result<Grading, A::Error> {
                let table = GradingTable::deserialize(de::value::MapAccessDeserializer::new(map))?;
                Grading::try_from(table).map_err(de::Error::custom)
            }
        }
        deserializer.deserialize_any(NameOrTable)
    }
}

impl Grading {
    /// Reads a curve from CSV: the header `sieve_mm,passing_percent`, one sieve per line, `#` comments.
    ///
    /// The sieves may stand in ascending or in descending order, as standards print them.
    ///
    /// # Errors
    /// A line that cannot be read, with its number, or a curve that breaks a rule of [`Grading::new`].
    pub fn from_csv(name: impl Into<String>, text: &str) -> Result<Self, GradingError> {
        let mut lines = (1_u64..)
            .zip(text.trim_start_matches('\u{feff}').lines())
            .map(|(number, line)| (number, line.split('#').next().unwrap_or("").trim()))
            .filter(|(_, line)| !line.is_empty());
        let header = lines.next().map_or("", |(_, line)| line);
        if header.split(',').map(str::trim).ne(["sieve_mm", "passing_percent"]) {
            return Err(GradingError::BadHeader { found: header.into() });
        }
        let mut sieves = Vec::new();
        for (line, text) in lines {
            let bad_row = || GradingError::BadRow { line, text: text.into() };
            let (size, passing) = text.split_once(',').ok_or_else(bad_row)?;
            sieves.push(Sieve::new(
                format!("{}mm", size.trim()).parse::<Metres>().map_err(|_| bad_row())?,
                format!("{}%", passing.trim()).parse::<Share>().map_err(|_| bad_row())?,
            ));
        }
        if sieves.windows(2).all(|pair| pair[0].size > pair[1].size) {
            sieves.reverse();
        }
        Self::new(name, sieves)
    }

    /// Writes the curve as the CSV that [`Grading::from_csv`] reads.
    pub fn to_csv(&self) -> String {
        let bare = |text: String| text.trim_end_matches(['m', '%', ' ']).to_owned();
        let rows =
            self.sieves().iter().map(|s| format!("{},{}\n", bare(s.size.in_unit("mm")), bare(s.passing.to_string())));
        format!("# {}\nsieve_mm,passing_percent\n{}", self.name(), rows.collect::<String>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn csv_reads_with_comments_and_in_either_order() {
        let up = "# quarry 7\nsieve_mm,passing_percent\n31.5,1.2 # damp\n63, 100\n";
        let down = "sieve_mm,passing_percent\n63,100\n31.5,1.2\n";
        let curve = Grading::from_csv("quarry", up).unwrap();
        assert_eq!(curve, Grading::from_csv("quarry", down).unwrap());
        assert_eq!(curve.sieves()[0], Sieve::new(Metres(0.0315), Share(0.012)));
        assert_eq!(Grading::from_csv("quarry", &curve.to_csv()).unwrap(), curve);
    }

    #[test]
    fn csv_errors_name_the_line() {
        let error = |text| Grading::from_csv("mine", text).unwrap_err().to_string();
        assert_eq!(
            error("63,100\n31.5,1.2\n"),
            "the grading begins with `63,100`\n\nhint: the first line must be `sieve_mm,passing_percent`"
        );
        assert_eq!(
            error("# mine\nsieve_mm,passing_percent\n31.5;1.2\n"),
            "line 3 of the grading is `31.5;1.2`, not a sieve and what passes it\n\nhint: write for example `31.5,1.2`"
        );
        assert!(error("sieve_mm,passing_percent\n31.5,nan\n63,100\n").starts_with("line 2"));
    }

    #[test]
    fn toml_reads_a_table_or_a_name_and_comes_back_the_same() {
        #[derive(Debug, PartialEq, Serialize, Deserialize)]
        struct Scene {
            grading: Grading,
        }
        let text = "[[grading.sieve]]\nsize = \"31.5mm\"\npassing = \"1.2%\"\n[[grading.sieve]]\nsize = \"63mm\"\npassing = \"100%\"\n";
        let scene: Scene = toml::from_str(text).unwrap();
        assert_eq!(scene.grading.sieves()[0], Sieve::new(Metres(0.0315), Share(0.012)));
        for name in Grading::names() {
            let scene: Scene = toml::from_str(&format!("grading = \"{name}\"")).unwrap();
            assert_eq!(toml::from_str::<Scene>(&toml::to_string(&scene).unwrap()).unwrap(), scene);
        }
        let error = toml::from_str::<Scene>("grading = \"benedetto2081\"").unwrap_err().to_string();
        assert!(error.contains("hint: did you mean `benedetto2018`?"), "{error}");
        let error = toml::from_str::<Scene>(&text.replace("100%", "99%")).unwrap_err().to_string();
        assert!(error.contains("the top sieve of 63 mm passes 99%"), "{error}");
    }
}
