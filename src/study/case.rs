//! A published case: `case.toml` with each quantity's value, tolerance and the reason for that tolerance.

use std::collections::BTreeMap;

/// One published quantity.
#[derive(Debug, Clone, PartialEq, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expected {
    /// Key by which the program's figure is found.
    pub key: String,
    /// What it is, in words, with its unit.
    pub quantity: String,
    /// Where it stands: table, figure, equation or section.
    pub place: String,
    /// The published value; absent where the program's figure is only reported.
    pub value: Option<f64>,
    /// Largest difference that still counts as agreement, in the quantity's unit; absent where it is only reported.
    pub tolerance: Option<f64>,
    /// Why that tolerance, or why there is none.
    pub why: String,
    /// Decimals to show.
    #[serde(default = "two")]
    pub decimals: usize,
    /// Whether the program's figure differs from machine to machine, as a time does.
    #[serde(default)]
    pub varies: bool,
}

const fn two() -> usize {
    2
}

/// A published case.
#[derive(Debug, Clone, PartialEq, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Name of the case, as on the command line.
    pub name: String,
    /// What is compared, in a line.
    pub title: String,
    /// The publication.
    pub reference: String,
    /// Its DOI.
    #[serde(default)]
    pub doi: String,
    /// Its quantities.
    pub expected: Vec<Expected>,
}

/// A case that cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CaseError {
    /// Not readable.
    #[error("the validation case `{name}` cannot be read: {message}")]
    Read {
        /// Name of the case.
        name: String,
        /// What the TOML reader said.
        message: String,
    },
    /// A quantity without a figure, or a figure without a quantity.
    #[error("the validation case `{name}` and the program disagree about `{key}`: {what}")]
    Mismatch {
        /// Name of the case.
        name: String,
        /// Key of the quantity.
        key: String,
        /// Which of the two lacks it.
        what: &'static str,
    },
}

/// Whether a figure agrees.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Within the tolerance.
    Agrees,
    /// Beyond it.
    Differs,
    /// No tolerance is set: the figure is reported only.
    Reported,
}

impl Verdict {
    /// The word in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Differs => "DIFFERS",
            Self::Reported => "reported",
        }
    }
}

/// One line of the comparison.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Row {
    /// What it is.
    pub quantity: String,
    /// Where it stands in the publication.
    pub place: String,
    /// The published value.
    pub paper: Option<f64>,
    /// The program's figure.
    pub ours: f64,
    /// Ours minus the paper's.
    pub difference: Option<f64>,
    /// Largest difference that counts as agreement.
    pub tolerance: Option<f64>,
    /// The verdict.
    pub verdict: Verdict,
    /// Why that tolerance.
    pub why: String,
    /// Decimals to show.
    pub decimals: usize,
    /// Whether the program's figure differs from machine to machine.
    pub varies: bool,
}

impl Case {
    /// Reads a case.
    ///
    /// # Errors
    /// With what the TOML reader said.
    pub fn read(name: &str, toml: &str) -> Result<Self, CaseError> {
        toml::from_str(toml).map_err(|error| CaseError::Read { name: name.into(), message: error.to_string() })
    }

    /// Sets the program's figures beside the published ones.
    ///
    /// # Errors
    /// When a quantity of the case has no figure, or a figure no quantity: nothing is left out in silence.
    pub fn compare(&self, ours: &BTreeMap<&str, f64>) -> Result<Vec<Row>, CaseError> {
        let mismatch = |key: &str, what| CaseError::Mismatch { name: self.name.clone(), key: key.into(), what };
        if let Some(key) = ours.keys().find(|key| !self.expected.iter().any(|expected| expected.key == **key)) {
            return Err(mismatch(key, "the case has no such quantity"));
        }
        self.expected
            .iter()
            .map(|expected| {
                let ours = *ours
                    .get(expected.key.as_str())
                    .ok_or_else(|| mismatch(&expected.key, "the program gave no figure for it"))?;
                let difference = expected.value.map(|value| ours - value);
                let verdict = match (difference, expected.tolerance) {
                    (Some(difference), Some(tolerance)) if difference.abs() <= tolerance => Verdict::Agrees,
                    (Some(_), Some(_)) => Verdict::Differs,
                    _ => Verdict::Reported,
                };
                Ok(Row {
                    quantity: expected.quantity.clone(),
                    place: expected.place.clone(),
                    paper: expected.value,
                    ours,
                    difference,
                    tolerance: expected.tolerance,
                    verdict,
                    why: expected.why.clone(),
                    decimals: expected.decimals,
                    varies: expected.varies,
                })
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = "name = \"c\"\ntitle = \"t\"\nreference = \"r\"\n\
        [[expected]]\nkey = \"h\"\nquantity = \"height, cm\"\nplace = \"p. 1\"\nvalue = 48.0\ntolerance = 1.5\nwhy = \"w\"\n";

    #[test]
    fn a_figure_beyond_the_tolerance_differs() {
        let case = Case::read("c", CASE).unwrap();
        let verdict = |h| case.compare(&BTreeMap::from([("h", h)])).unwrap()[0].verdict;
        assert_eq!(verdict(49.4), Verdict::Agrees);
        assert_eq!(verdict(49.6), Verdict::Differs);
        assert_eq!(verdict(f64::NAN), Verdict::Differs);
    }

    #[test]
    fn nothing_is_left_out_in_silence() {
        let case = Case::read("c", CASE).unwrap();
        assert!(case.compare(&BTreeMap::new()).is_err());
        assert!(case.compare(&BTreeMap::from([("h", 48.0), ("x", 1.0)])).is_err());
        assert!(Case::read("c", "nonsense = 1").is_err());
    }
}
