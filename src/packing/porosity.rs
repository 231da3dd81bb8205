//! The void share of a bed.

use crate::units::Share;

use super::error::PackingError;

/// The share of a bed that is void, above 0 % and below 100 %.
///
/// The compaction rate of the paper, `P_c`, is what the voids leave: [`Porosity::solid_share`].
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, serde::Serialize, serde::Deserialize)]
#[serde(try_from = "Share", into = "Share")]
pub struct Porosity(f64);

impl Porosity {
    /// The voids of the tank of Benedetto et al. 2018 (section 5.2.1): 42 %.
    pub const BENEDETTO_2018: Self = Self(0.42);

    /// Takes a void share.
    ///
    /// # Errors
    /// 0 % and less, 100 % and more, and what is not a number.
    pub fn new(void_share: Share) -> Result<Self, PackingError> {
        let value = void_share.si();
        if value <= 0.0 {
            return Err(PackingError::NoVoids { voids: void_share });
        }
        if value >= 1.0 {
            return Err(PackingError::NoStones { voids: void_share });
        }
        if value.is_nan() {
            return Err(PackingError::VoidsNotANumber);
        }
        Ok(Self(value))
    }

    /// The share that is void.
    pub fn void_share(self) -> Share {
        Share(self.0)
    }

    /// The share that is stone.
    pub fn solid_share(self) -> Share {
        Share(1.0 - self.0)
    }
}

impl TryFrom<Share> for Porosity {
    type Error = PackingError;
    fn try_from(void_share: Share) -> Result<Self, PackingError> {
        Self::new(void_share)
    }
}

impl From<Porosity> for Share {
    fn from(porosity: Porosity) -> Self {
        porosity.void_share()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neither_all_stone_nor_all_void() {
        assert_eq!(
            Porosity::new(Share(0.0)).unwrap_err().to_string(),
            "voids of 0% leave no space between the stones\n\nhint: the tank of Benedetto et al. 2018 had 42%"
        );
        assert_eq!(
            Porosity::new(Share(1.0)).unwrap_err().to_string(),
            "voids of 100% leave no stones\n\nhint: the tank of Benedetto et al. 2018 had 42%"
        );
        assert!(Porosity::new(Share(f64::NAN)).is_err());
        assert!(Porosity::new(Share(-0.2)).is_err());
        assert_eq!(Porosity::BENEDETTO_2018.solid_share().si(), 1.0 - 0.42);
    }

    #[test]
    fn it_reads_and_writes_itself_in_percent() {
        let voids: Porosity = serde_json::from_str("\"42%\"").unwrap();
        assert_eq!(voids, Porosity::BENEDETTO_2018);
        assert_eq!(serde_json::to_string(&voids).unwrap(), "\"42%\"");
        assert!(serde_json::from_str::<Porosity>("\"100%\"").is_err());
    }
}
