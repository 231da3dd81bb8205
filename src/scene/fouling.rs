//! Fouling as users say it, and what it comes to.

use std::fmt;
use std::str::FromStr;

use crate::material::FoulingIndices;
use crate::units::{Metres, Share};

use super::error::SceneError;

/// How much fouling there is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FoulingAmount {
    /// Height of the fouled zone from the bottom.
    Height(Metres),
    /// Share of all voids of the bed that hold fines.
    OfVoids(Share),
    /// Bulk volume of the fines as a share of the column of bed and base plate (Benedetto 2017, Table 4: 8/16/24 %).
    ByVolume(Share),
    /// Mass of the fines as a share of the mass of stones and fines.
    ByMass(Share),
}

impl FromStr for FoulingAmount {
    type Err = SceneError;

    fn from_str(text: &str) -> Result<Self, SceneError> {
        let unknown = || SceneError::FoulingText { text: text.into() };
        let Some((number, rest)) = text.split_once('%') else {
            return text.parse().map(Self::Height).map_err(|_| unknown());
        };
        let share: Share = format!("{number}%").parse().map_err(|_| unknown())?;
        let words = rest.trim().trim_start_matches("of ").trim_start_matches("by ").trim();
        match words {
            "voids" | "void" | "the voids" => Ok(Self::OfVoids(share)),
            "volume" | "vol" => Ok(Self::ByVolume(share)),
            "mass" | "weight" => Ok(Self::ByMass(share)),
            _ => Err(unknown()),
        }
    }
}

impl fmt::Display for FoulingAmount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Height(height) => write!(f, "{height}"),
            Self::OfVoids(share) => write!(f, "{share} of voids"),
            Self::ByVolume(share) => write!(f, "{share} by volume"),
            Self::ByMass(share) => write!(f, "{share} by mass"),
        }
    }
}

impl serde::Serialize for FoulingAmount {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> serde::Deserialize<'de> for FoulingAmount {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}

/// The fouling of a scene in every measure the field uses.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct FoulingReport {
    /// Height of the fouled zone.
    pub height: Metres,
    /// Bulk volume of the fines over the volume of bed and base plate, %: the measure of Benedetto 2017, Table 4.
    pub volume_percent_of_column: f64,
    /// From the nominal bed: void share and height as the scene says them.
    pub nominal: FoulingIndices,
    /// From the stones and voids of the packing itself; absent without one.
    pub of_packing: Option<FoulingIndices>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amounts_are_read_as_users_say_them() {
        let read = |text: &str| text.parse::<FoulingAmount>().unwrap();
        assert_eq!(read("20cm"), FoulingAmount::Height(Metres(0.2)));
        assert_eq!(read("40% of voids"), FoulingAmount::OfVoids(Share(0.4)));
        assert_eq!(read("16% by volume"), FoulingAmount::ByVolume(Share(0.16)));
        assert_eq!(read("16%vol"), FoulingAmount::ByVolume(Share(0.16)));
        assert_eq!(read("14 % by mass"), FoulingAmount::ByMass(Share(0.14)));
        for text in ["20cm", "40% of voids", "16% by volume", "14% by mass"] {
            assert_eq!(read(&read(text).to_string()), read(text));
        }
        for wrong in ["20", "20%", "much", "20% of beer"] {
            let message = wrong.parse::<FoulingAmount>().unwrap_err().to_string();
            assert_eq!(
                message,
                format!(
                    "`{wrong}` is not an amount of fouling\n\nhint: write a height (`20cm`), `40% of voids`, `16% by volume` or `14% by mass`"
                )
            );
        }
    }
}
