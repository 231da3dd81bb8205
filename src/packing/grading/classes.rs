//! From a curve to size classes: which stones the mass retained on a sieve is made of.

use crate::units::{Metres, Share};

use super::curve::Grading;
use super::error::GradingError;

/// The most that may pass the smallest sieve: 5 %.
///
/// The curve says nothing about the size of what passes its smallest sieve (0.3 % below 22.4 mm in the paper). This share
/// is folded into the finest class: it keeps the solid area, adds no sieve that nobody measured, and shifts the output
/// curve by no more than itself, at that sieve alone. The most among the built-in gradings is 3.5 % (`en13450-f`).
/// Beyond 5 % a smaller sieve is asked for.
pub const LARGEST_UNSIZED_SHARE: Share = Share(0.05);

/// Which diameters the share retained on a sieve stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum ClassReading {
    /// As sieving means it (EN 933-1): what lies on a sieve is larger than it and smaller than the next larger sieve.
    #[default]
    #[serde(rename = "en-933-1")]
    En933,
    /// Each class one sieve coarser: what lies on sieve `i` is drawn between the next larger sieve and the one above.
    ///
    /// The paper's own output, 200 circles of 25–80 mm, does not follow from its Table 1, in which 63 mm passes all; it
    /// nearly does with this reading. The stones are then too large; it is there to reproduce the figures.
    #[serde(rename = "one-sieve-up")]
    OneSieveUp,
}

/// A size class: a share of the mass with its range of diameters.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SizeClass {
    /// Smallest diameter.
    pub smallest: Metres,
    /// Largest diameter.
    pub largest: Metres,
    /// Share of the mass, `F_i / 100`.
    pub share: Share,
}

impl Grading {
    /// Splits the curve into classes, coarsest first; empty ones are left out and the shares add up to 1.
    ///
    /// What passes the smallest sieve belongs to the finest class under [`ClassReading::En933`] (see
    /// [`LARGEST_UNSIZED_SHARE`]); under [`ClassReading::OneSieveUp`] it is the class between the two smallest sieves.
    /// When [`ClassReading::OneSieveUp`] needs a sieve above the top one, it takes the ratio of the two topmost once more.
    ///
    /// # Errors
    /// More than 5 % passes the smallest sieve.
    pub fn classes(&self, reading: ClassReading) -> Result<Vec<SizeClass>, GradingError> {
        let sieves = self.sieves();
        let unsized_share = sieves[0].passing;
        if unsized_share > LARGEST_UNSIZED_SHARE {
            return Err(GradingError::UnsizedShare {
                size: sieves[0].size,
                passing: unsized_share,
                limit: LARGEST_UNSIZED_SHARE,
            });
        }
        let count = sieves.len();
        let above_top = Metres(sieves[count - 1].size.si() * sieves[count - 1].size.si() / sieves[count - 2].size.si());
        let edge = |k: usize| if k < count { sieves[k].size } else { above_top };
        let shift = usize::from(reading == ClassReading::OneSieveUp);
        let mut classes: Vec<SizeClass> = (0..count - 1)
            .map(|k| SizeClass {
                smallest: edge(k + shift),
                largest: edge(k + 1 + shift),
                share: Share(sieves[k + 1].passing.si() - sieves[k].passing.si()),
            })
            .collect();
        match reading {
            ClassReading::OneSieveUp => {
                classes.insert(0, SizeClass { smallest: edge(0), largest: edge(1), share: unsized_share });
            }
            ClassReading::En933 => {
                if let Some(finest) = classes.iter_mut().find(|class| class.share.si() > 0.0) {
                    finest.share = Share(finest.share.si() + unsized_share.si());
                }
            }
        }
        classes.retain(|class| class.share.si() > 0.0);
        classes.reverse();
        Ok(classes)
    }

    /// Share of the mass that passes a diameter, straight lines between the sieves; below the smallest sieve what passes
    /// it, above the largest 1.
    pub fn passing_at(&self, diameter: Metres) -> Share {
        let sieves = self.sieves();
        let above = sieves.partition_point(|sieve| sieve.size < diameter);
        match (above.checked_sub(1).and_then(|k| sieves.get(k)), sieves.get(above)) {
            (None, Some(first)) => first.passing,
            (_, None) => Share(1.0),
            (Some(low), Some(high)) => {
                let t = (diameter.si() - low.size.si()) / (high.size.si() - low.size.si());
                Share(low.passing.si() + t * (high.passing.si() - low.passing.si()))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(reading: ClassReading) -> Vec<(f64, f64, f64)> {
        let classes = Grading::benedetto2018().unwrap().classes(reading).unwrap();
        let round = |v: f64| (v * 1e7).round() / 1e4;
        classes.iter().map(|c| (round(c.smallest.si()), round(c.largest.si()), round(c.share.si()) / 10.0)).collect()
    }

    /// Differences of Table 1 of the paper; 0.3 % under 22.4 mm joins the finest class.
    #[test]
    fn classes_as_sieving_means_them() {
        let expected = [(50.0, 63.0, 20.1), (40.0, 50.0, 49.3), (31.5, 40.0, 29.4), (22.4, 31.5, 1.2)];
        assert_eq!(rows(ClassReading::En933), expected);
    }

    /// The paper's range of diameters reaches 80 mm: the same shares, one sieve coarser.
    #[test]
    fn classes_one_sieve_up() {
        let expected =
            [(63.0, 80.0, 20.1), (50.0, 63.0, 49.3), (40.0, 50.0, 29.4), (31.5, 40.0, 0.9), (22.4, 31.5, 0.3)];
        assert_eq!(rows(ClassReading::OneSieveUp), expected);
    }

    #[test]
    fn too_much_below_the_smallest_sieve_is_refused() {
        let text = "sieve_mm,passing_percent\n31.5,12\n63,100\n";
        let error = Grading::from_csv("mine", text).unwrap().classes(ClassReading::En933).unwrap_err().to_string();
        assert_eq!(
            error,
            "12% passes the smallest sieve of 31.5 mm, and nothing says how small that is: at most 5% is given the size of the class above\n\nhint: add a smaller sieve"
        );
    }

    #[test]
    fn the_readings_have_names() {
        assert_eq!(serde_json::to_string(&ClassReading::En933).unwrap(), "\"en-933-1\"");
        assert_eq!(serde_json::to_string(&ClassReading::OneSieveUp).unwrap(), "\"one-sieve-up\"");
    }

    /// Half-way between 40 mm (30.6 %) and 50 mm (79.9 %) is 55.25 %.
    #[test]
    fn the_curve_is_straight_between_sieves() {
        let curve = Grading::benedetto2018().unwrap();
        assert!((curve.passing_at(Metres(0.045)).si() - 0.5525).abs() < 1e-12);
        assert_eq!(curve.passing_at(Metres(0.1)), Share(1.0));
        assert_eq!(curve.passing_at(Metres(0.01)), Share(0.003));
    }
}
