//! The checked sieve curve.

use crate::units::{Metres, Share};

use super::error::GradingError;

/// How sure the numbers of a built-in grading are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
pub enum Confidence {
    /// Read in the source named.
    A,
    /// Quoted from memory of the standard, consistent in itself: check against the standard before you rely on it.
    B,
    /// Not verified.
    C,
}

/// One sieve and the share of the mass that passes it.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sieve {
    /// Opening of the sieve.
    pub size: Metres,
    /// Share of the mass that passes.
    pub passing: Share,
    /// Lowest share that the standard allows, for a band.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lowest: Option<Share>,
    /// Highest share that the standard allows, for a band.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub highest: Option<Share>,
}

impl Sieve {
    /// A sieve without a band.
    pub fn new(size: Metres, passing: Share) -> Self {
        Self { size, passing, lowest: None, highest: None }
    }
}

/// A sieve curve that has been checked: ascending sieves, none twice, shares in 0–100 % that never fall from a sieve to
/// a larger one, and a top sieve that passes everything.
///
/// Written and read as a table with `[[sieve]] size = "63mm" passing = "100%"` rows; a built-in may also be given by its
/// name alone.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(into = "super::text::GradingTable")]
pub struct Grading {
    name: String,
    confidence: Option<Confidence>,
    sieves: Vec<Sieve>,
}

impl Grading {
    /// Checks a curve, sieves from the smallest to the largest.
    ///
    /// # Errors
    /// The first rule broken, naming the sieve and the values.
    pub fn new(name: impl Into<String>, sieves: Vec<Sieve>) -> Result<Self, GradingError> {
        check(&sieves)?;
        Ok(Self { name: name.into(), confidence: None, sieves })
    }

    pub(super) fn with_confidence(mut self, confidence: Option<Confidence>) -> Self {
        self.confidence = confidence;
        self
    }

    /// What the grading is called.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// How sure the numbers of a built-in are: the least sure of its rows. None for a user's own curve.
    pub fn confidence(&self) -> Option<Confidence> {
        self.confidence
    }

    /// The sieves, from the smallest to the largest; at least two.
    pub fn sieves(&self) -> &[Sieve] {
        &self.sieves
    }
}

fn check(sieves: &[Sieve]) -> Result<(), GradingError> {
    let [.., top] = sieves else { return Err(GradingError::TooFewSieves { found: 0 }) };
    if sieves.len() < 2 {
        return Err(GradingError::TooFewSieves { found: sieves.len() });
    }
    for sieve in sieves {
        let (size, passing) = (sieve.size, sieve.passing);
        if !(size.si() > 0.0 && size.si().is_finite()) {
            return Err(GradingError::NotASize { size });
        }
        if !(0.0..=1.0).contains(&passing.si()) {
            return Err(GradingError::PassingOutOfRange { size, passing });
        }
    }
    for (k, pair) in sieves.windows(2).enumerate() {
        let (smaller, larger) = (pair[0], pair[1]);
        if sieves[..=k].iter().any(|sieve| sieve.size == larger.size) {
            return Err(GradingError::Duplicate { size: larger.size });
        }
        if larger.size < smaller.size {
            return Err(GradingError::NotAscending { previous: smaller.size, size: larger.size });
        }
        if larger.passing < smaller.passing {
            return Err(GradingError::NotMonotone {
                smaller: smaller.size,
                smaller_passing: smaller.passing,
                larger: larger.size,
                larger_passing: larger.passing,
            });
        }
    }
    if top.passing.si() < 1.0 {
        return Err(GradingError::TopSieveRetains { size: top.size, passing: top.passing });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(rows: &[(&str, &str)]) -> String {
        let sieves = rows.iter().map(|(s, p)| Sieve::new(s.parse().unwrap(), p.parse().unwrap())).collect();
        Grading::new("mine", sieves).unwrap_err().to_string()
    }

    #[test]
    fn each_broken_rule_is_named_with_the_sieve_and_the_values() {
        assert_eq!(
            message(&[("63mm", "100%")]),
            "a grading needs at least 2 sieves, and this one has 1\n\nhint: list every sieve with what passes it, from the smallest to the largest"
        );
        assert_eq!(message(&[]).lines().next(), Some("a grading needs at least 2 sieves, and this one has 0"));
        assert_eq!(
            message(&[("0mm", "0%"), ("63mm", "100%")]),
            "a sieve of 0 mm is no sieve: its size must be above 0 mm and finite"
        );
        assert_eq!(
            message(&[("22.4mm", "-1%"), ("63mm", "100%")]),
            "the 22.4 mm sieve passes -1%, which is not between 0% and 100%"
        );
        assert_eq!(
            message(&[("22.4mm", "1%"), ("63mm", "100.5%")]),
            "the 63 mm sieve passes 100.5%, which is not between 0% and 100%"
        );
        assert_eq!(
            message(&[("40mm", "1%"), ("40mm", "20%"), ("63mm", "100%")]),
            "the 40 mm sieve is listed twice\n\nhint: keep one row per sieve"
        );
        assert_eq!(
            message(&[("50mm", "30%"), ("40mm", "20%"), ("63mm", "100%")]),
            "the 40 mm sieve follows the 50 mm sieve: sieves go from the smallest to the largest\n\nhint: put the 40 mm sieve before it"
        );
        assert_eq!(
            message(&[("40mm", "30%"), ("50mm", "20%"), ("63mm", "100%")]),
            "the 50 mm sieve passes 20% but the smaller 40 mm sieve passes 30%: what passes a sieve passes every larger one\n\nhint: give the share that passes, not the share retained"
        );
        assert_eq!(
            message(&[("40mm", "30%"), ("50mm", "97.5%")]),
            "the top sieve of 50 mm passes 97.5%, so nothing says how large the other stones are\n\nhint: add a larger sieve that passes 100%"
        );
    }
}
