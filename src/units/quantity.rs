//! The quantity types. Each holds one `f64` in SI and reads and writes itself as text with a unit.

use super::parse::{UnitError, parse, shortest};

macro_rules! quantity {
    ($(#[$doc:meta])* $name:ident, $dimension:literal, $example:literal, [$(($unit:literal, $power:literal)),+ $(,)?], $stored:literal) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default)]
        pub struct $name(pub f64);

        impl $name {
            const UNITS: &'static [(&'static str, i32)] = &[$(($unit, $power)),+];

            /// The value in SI.
            pub const fn si(self) -> f64 {
                self.0
            }

            /// The value in the unit named, with the shortest digits that read back to the same bits.
            ///
            /// An unknown unit falls back to the unit this quantity is stored in.
            pub fn in_unit(self, unit: &str) -> String {
                let (name, power) = Self::UNITS
                    .iter()
                    .find(|(name, _)| *name == unit)
                    .or_else(|| Self::UNITS.iter().find(|(name, _)| *name == $stored))
                    .copied()
                    .unwrap_or(("", 0));
                if name == "%" { format!("{}%", shortest(self.0, power)) } else { format!("{} {name}", shortest(self.0, power)) }
            }
        }

        impl std::str::FromStr for $name {
            type Err = UnitError;
            fn from_str(text: &str) -> Result<Self, UnitError> {
                parse(text, $dimension, Self::UNITS, $example).map(Self)
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(&self.in_unit($stored))
            }
        }

        impl serde::Serialize for $name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.collect_str(self)
            }
        }

        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                struct Text;
                impl serde::de::Visitor<'_> for Text {
                    type Value = $name;
                    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                        write!(f, "a {} with its unit in quotes, for example \"{}\"", $dimension, $example)
                    }
                    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<$name, E> {
                        text.parse().map_err(E::custom)
                    }
                }
                deserializer.deserialize_any(Text)
            }
        }
    };
}

quantity!(
    /// A length in metres.
    Metres, "length", "20cm", [("m", 0), ("cm", -2), ("mm", -3), ("um", -6), ("µm", -6), ("km", 3)], "m"
);
quantity!(
    /// A time in seconds.
    Seconds, "time", "25ns", [("s", 0), ("ms", -3), ("us", -6), ("µs", -6), ("ns", -9), ("ps", -12)], "ns"
);
quantity!(
    /// A frequency in hertz.
    Hertz, "frequency", "1GHz", [("Hz", 0), ("kHz", 3), ("MHz", 6), ("GHz", 9)], "GHz"
);
quantity!(
    /// An electric conductivity in siemens per metre.
    SiemensPerMetre, "conductivity", "5mS/m", [("S/m", 0), ("mS/m", -3), ("uS/m", -6), ("µS/m", -6)], "S/m"
);
quantity!(
    /// A mass density in kilograms per cubic metre.
    KilogramsPerCubicMetre, "density", "2800kg/m3", [("kg/m3", 0), ("kg/m³", 0), ("g/cm3", 3), ("g/cm³", 3), ("t/m3", 3)], "kg/m3"
);
quantity!(
    /// A stress or a modulus in pascals.
    Pascals, "stress", "17.7GPa", [("Pa", 0), ("kPa", 3), ("MPa", 6), ("GPa", 9)], "Pa"
);
quantity!(
    /// A mass in kilograms.
    Kilograms, "mass", "285kg", [("kg", 0), ("g", -3), ("t", 3)], "kg"
);
quantity!(
    /// A speed in metres per second.
    MetresPerSecond, "speed", "1mm/s", [("m/s", 0), ("cm/s", -2), ("mm/s", -3)], "m/s"
);
quantity!(
    /// A share of a whole, 1 being all of it; written in percent.
    Share, "share", "42%", [("%", -2)], "%"
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_scaled_in_decimal() {
        assert_eq!("48cm".parse::<Metres>(), Ok(Metres(0.48)));
        assert_eq!("0.48 m".parse::<Metres>(), Ok(Metres(0.48)));
        assert_eq!("58%".parse::<Share>(), Ok(Share(0.58)));
        assert_eq!("1.5e3 MHz".parse::<Hertz>(), Ok(Hertz(1.5e9)));
        assert_eq!("25ns".parse::<Seconds>(), Ok(Seconds(25e-9)));
        assert_eq!("2.8 g/cm3".parse::<KilogramsPerCubicMetre>(), Ok(KilogramsPerCubicMetre(2800.0)));
    }

    #[test]
    fn text_reads_back_to_the_same_bits() {
        for v in [0.48, 1.0 / 3.0, 4.717308673499368e-12, 1e-30, 6.02e23, 0.1 + 0.2, 25e-9, 0.0] {
            assert_eq!(Metres(v).to_string().parse::<Metres>(), Ok(Metres(v)));
            assert_eq!(Seconds(v).to_string().parse::<Seconds>(), Ok(Seconds(v)));
            assert_eq!(Share(v).to_string().parse::<Share>(), Ok(Share(v)));
        }
        assert_eq!(Metres(0.2).in_unit("cm"), "20 cm");
        assert_eq!(Seconds(25e-9).to_string(), "25 ns");
        assert_eq!(Share(0.42).to_string(), "42%");
    }

    #[test]
    fn a_bare_number_and_a_foreign_unit_are_refused() {
        let bare = "20".parse::<Metres>().unwrap_err().to_string();
        assert_eq!(
            bare,
            "`20` has no unit: a length needs one of m, cm, mm, um, µm, km\n\nhint: write for example `20cm`"
        );
        let foreign = "20 furlongs".parse::<Metres>().unwrap_err().to_string();
        assert!(foreign.starts_with("`20 furlongs` has the unknown unit `furlongs`"), "{foreign}");
        assert!("nan m".parse::<Metres>().is_err());
        assert!("inf m".parse::<Metres>().is_err());
        assert!("1e999 m".parse::<Metres>().is_err());
        assert!("m".parse::<Metres>().is_err());
    }
}
