//! The gradings that are known by name, out of `validation/tables/grading_curves.csv`.

use crate::files::nearest_name;
use crate::units::{Metres, Share};

use super::curve::{Confidence, Grading, Sieve};
use super::error::GradingError;

const TABLE: &str = include_str!("../../../validation/tables/grading_curves.csv");

/// Name, then `standard` and `category` of the table.
const NAMES: [(&str, &str, &str); 22] = [
    ("benedetto2018", "Benedetto 2018 Table 1", "Roma Tre limestone"),
    ("en13450-a", "EN 13450:2013 (31.5/50)", "A"),
    ("en13450-b", "EN 13450:2013 (31.5/50)", "B"),
    ("en13450-c", "EN 13450:2013 (31.5/50)", "C"),
    ("en13450-d", "EN 13450:2013 (31.5/63)", "D"),
    ("en13450-e", "EN 13450:2013 (31.5/63)", "E"),
    ("en13450-f", "EN 13450:2013 (31.5/63)", "F"),
    ("sbb-32-50", "SBB Gleisschotter 32/50 cl.1-2", ""),
    ("arema-24", "AREMA", "24"),
    ("arema-25", "AREMA", "25"),
    ("arema-3", "AREMA", "3"),
    ("arema-4a", "AREMA", "4A"),
    ("arema-4", "AREMA", "4"),
    ("arema-5", "AREMA", "5"),
    ("arema-57", "AREMA", "57"),
    ("irs-ge-1", "IRS-GE-1 (India)", "machine crushed"),
    ("as2758-60", "AS 2758.7", "nominal 60"),
    ("as2758-60-steel", "AS 2758.7", "60 (steel sleepers)"),
    ("network-rail-2000", "Network Rail RT/CE/S/006 iss.3 (2000)", ""),
    ("tbt2140-premium", "TB/T 2140 (China)", "premium"),
    ("tbt2140-first", "TB/T 2140 (China)", "first grade (new line)"),
    ("lim-37.5-50", "Lim (Nottingham DEM)", "single size 37.5-50"),
];

impl Grading {
    /// Takes a built-in grading by its name (see [`Grading::names`]).
    ///
    /// A standard gives a band per sieve: the curve is the middle of the band, which falls nowhere because neither edge
    /// of a band does. The top sieve takes the upper edge of its band, 100 %, for otherwise nothing would say how large
    /// the stones on it are (`irs-ge-1` allows 5 % on 65 mm, `tbt2140-first` 3 % on 63 mm). The band stays with the
    /// sieve.
    ///
    /// # Errors
    /// An unknown name, with the nearest known one.
    pub fn named(name: &str) -> Result<Self, GradingError> {
        let unknown = || {
            let hint = nearest_name(name, Self::names()).map_or_else(
                || format!("one of {}", Self::names().collect::<Vec<_>>().join(", ")),
                |near| format!("did you mean `{near}`?"),
            );
            GradingError::UnknownName { name: name.into(), hint }
        };
        let (name, standard, category) =
            NAMES.iter().find(|(known, ..)| known.eq_ignore_ascii_case(name)).ok_or_else(unknown)?;
        let mut sieves = Vec::new();
        let mut confidence = Confidence::A;
        for (number, line) in (1..).zip(TABLE.lines()) {
            let fields: Vec<&str> = line.split(',').collect();
            let [row_standard, row_category, size, lowest, highest, mark, ..] = fields[..] else { continue };
            if (row_standard, row_category) != (*standard, *category) {
                continue;
            }
            let bad_row = || GradingError::BadRow { line: number, text: line.into() };
            let share = |text: &str| format!("{text}%").parse::<Share>().map_err(|_| bad_row());
            let (lowest, highest) = (share(lowest)?, share(highest)?);
            confidence = confidence.max(match mark {
                "A" => Confidence::A,
                "B" => Confidence::B,
                _ => Confidence::C,
            });
            sieves.push(Sieve {
                size: format!("{size}mm").parse::<Metres>().map_err(|_| bad_row())?,
                passing: if lowest == highest { lowest } else { Share(0.5 * (lowest.si() + highest.si())) },
                lowest: (lowest != highest).then_some(lowest),
                highest: (lowest != highest).then_some(highest),
            });
        }
        sieves.sort_by(|a, b| a.size.si().total_cmp(&b.size.si()));
        if let Some(top) = sieves.last_mut() {
            top.passing = top.highest.unwrap_or(top.passing);
        }
        Ok(Self::new(*name, sieves)?.with_confidence(Some(confidence)))
    }

    /// The names of the built-in gradings.
    pub fn names() -> impl Iterator<Item = &'static str> {
        NAMES.iter().map(|(name, ..)| *name)
    }

    /// The ballast of the tank: Table 1 of Benedetto et al. 2018.
    ///
    /// # Errors
    /// None in practice: the table is part of the program.
    pub fn benedetto2018() -> Result<Self, GradingError> {
        Self::named("benedetto2018")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packing::grading::ClassReading;

    /// Table 1 of the paper, word for word.
    #[test]
    fn the_curve_of_the_paper() {
        let curve = Grading::benedetto2018().unwrap();
        let rows: Vec<_> = curve.sieves().iter().map(|s| (s.size.in_unit("mm"), s.passing.to_string())).collect();
        let paper = [
            ("22.4 mm", "0.3%"),
            ("31.5 mm", "1.2%"),
            ("40 mm", "30.6%"),
            ("50 mm", "79.9%"),
            ("63 mm", "100%"),
            ("80 mm", "100%"),
        ];
        assert!(rows.iter().map(|(a, b)| (a.as_str(), b.as_str())).eq(paper), "{rows:?}");
        assert_eq!(curve.confidence(), Some(Confidence::A));
    }

    #[test]
    fn every_name_is_a_grading_with_classes_and_every_row_of_the_table_is_used() {
        let mut rows = 0;
        for name in Grading::names() {
            let grading = Grading::named(name).unwrap();
            assert_eq!(grading.name(), name);
            rows += grading.sieves().len();
            for reading in [ClassReading::En933, ClassReading::OneSieveUp] {
                let classes = grading.classes(reading).unwrap();
                let total: f64 = classes.iter().map(|class| class.share.si()).sum();
                assert!((total - 1.0).abs() < 1e-12, "{name}: {total}");
            }
            for sieve in grading.sieves() {
                if let (Some(lowest), Some(highest)) = (sieve.lowest, sieve.highest) {
                    assert!(lowest <= sieve.passing && sieve.passing <= highest, "{name} {sieve:?}");
                }
            }
        }
        assert_eq!(rows, TABLE.lines().filter(|l| !l.starts_with(['#', 's'])).count());
    }

    /// EN 13450 category A allows 70–99 % at 50 mm; the middle is 84.5 %.
    #[test]
    fn a_band_is_packed_along_its_middle() {
        let curve = Grading::named("EN13450-A").unwrap();
        let sieve = curve.sieves()[3];
        assert_eq!((sieve.size, sieve.passing), (Metres(0.05), Share(0.845)));
        assert_eq!((sieve.lowest, sieve.highest), (Some(Share(0.7)), Some(Share(0.99))));
        assert_eq!(curve.confidence(), Some(Confidence::B));
    }

    #[test]
    fn an_unknown_name_is_answered_with_the_nearest() {
        let error = Grading::named("en13450-g").unwrap_err().to_string();
        assert_eq!(error, "no grading is called `en13450-g`\n\nhint: did you mean `en13450-a`?");
        let error = Grading::named("my curve from the quarry").unwrap_err().to_string();
        assert!(error.contains("hint: one of benedetto2018, en13450-a, "), "{error}");
    }
}
