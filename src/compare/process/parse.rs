//! Chains of steps as a user writes them.

use super::filter::Band;
use super::running::Running;
use crate::units::{Hertz, Metres, Seconds};

/// Order of a Butterworth filter where none is given.
const ORDER: usize = 4;

/// Every step as it is written, and what it does.
pub const STEPS: &[(&str, &str)] = &[
    (
        "timezero=direct|first|surface|TIME|plate:HEIGHT",
        "moves the time axis: the direct wave, the first strong peak, the surface echo or TIME becomes zero; `plate:0.43m` puts the plate echo at 2 HEIGHT/c. Echoes are found once offset and drift are off",
    ),
    ("dc", "takes the mean of each trace off"),
    ("dewow=WINDOW[:median]", "takes a running mean (or median) off: slow drift goes"),
    (
        "bandpass=FROM..TO[:ORDER]",
        "keeps a band: Butterworth of order 4 (or ORDER), forwards and backwards, so that no echo moves",
    ),
    ("highpass=FROM[:ORDER], lowpass=TO[:ORDER]", "the same with one corner"),
    ("background[=TRACES]", "takes the mean of all traces off, or the moving mean of so many"),
    (
        "stack[=all|TRACES][:LEAST]",
        "means of all traces, or of each so many, without outliers: a trace is dropped when its correlation with the median trace is below LEAST (by default: when it lacks of one over 4 times what traces usually lack, and over 0.001)",
    ),
    ("sec=RATE[:POWER]", "multiplies by exp(RATE t) t^POWER, t in ns from time zero, RATE per ns"),
    ("agc=WINDOW", "divides by the level (root of the mean square) in a window"),
    ("envelope", "puts the envelope in the place of each trace"),
    ("crop=FROM..TO", "keeps a part of the time axis"),
    ("resample=STEP", "another time step, band-limited"),
    ("normalise=max|direct|surface|plate", "divides by the largest amplitude or by that of an echo"),
    ("flip", "turns the sign"),
];

/// What is put at a known time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ZeroAt {
    /// The direct wave becomes zero.
    DirectWave,
    /// The first strong extremum becomes zero.
    FirstPeak,
    /// The surface echo becomes zero.
    Surface,
    /// This time becomes zero.
    Time(Seconds),
    /// The plate echo (the strongest after the direct wave) comes to twice this height over the speed of light.
    Plate(Metres),
}

/// By what amplitudes are divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NormaliseBy {
    /// The largest absolute amplitude.
    Maximum,
    /// The direct wave.
    DirectWave,
    /// The surface echo.
    Surface,
    /// The plate echo.
    Plate,
}

/// One step of a chain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Instruction {
    /// Moves the time axis.
    TimeZero(ZeroAt),
    /// Takes means off.
    RemoveDc,
    /// See [`dewow`](super::dewow).
    Dewow(Seconds, Running),
    /// See [`filter`](super::filter()): band and order.
    Filter(Band, usize),
    /// See [`remove_background`](super::remove_background).
    Background(Option<usize>),
    /// See [`stack`](super::stack): traces of a group, least correlation.
    Stack(Option<usize>, Option<f64>),
    /// See [`gain_by_time`](super::gain_by_time): rate per ns and power.
    GainByTime(f64, f64),
    /// See [`gain_by_level`](super::gain_by_level).
    GainByLevel(Seconds),
    /// See [`take_envelope`](super::take_envelope).
    Envelope,
    /// Keeps a part.
    Crop(Seconds, Seconds),
    /// Another time step.
    Resample(Seconds),
    /// Divides.
    Normalise(NormaliseBy),
    /// Turns the sign.
    Flip,
}

/// Steps in the order in which they are done, each with its words.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Chain {
    /// Each step and how it was written.
    pub steps: Vec<(Instruction, String)>,
}

/// Why a chain cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ParseError {
    /// A word that is no step.
    #[error("`{word}` is no step{}", nearest.as_ref().map_or_else(|| format!(": known are {known}"), |name| format!("\n\nhint: did you mean `{name}`?")))]
    Unknown {
        /// The word.
        word: String,
        /// The step that it resembles.
        nearest: Option<&'static str>,
        /// All steps.
        known: String,
    },
    /// A value that a step does not take.
    #[error("`{step}` cannot be read: {reason}\n\nhint: write it as `{form}`")]
    Value {
        /// The step as it was written.
        step: String,
        /// What is wrong.
        reason: String,
        /// How it is written.
        form: &'static str,
    },
    /// Nothing at all.
    #[error("there is no step in it\n\nhint: for example `dewow=3ns, bandpass=300MHz..1.5GHz, background`")]
    Empty,
}

/// Names of the steps and how each is written.
const FORMS: [(&str, &str); 15] = [
    ("timezero", "timezero=direct"),
    ("dc", "dc"),
    ("dewow", "dewow=3ns"),
    ("bandpass", "bandpass=300MHz..1.5GHz"),
    ("highpass", "highpass=300MHz"),
    ("lowpass", "lowpass=1.5GHz"),
    ("background", "background=100"),
    ("stack", "stack=10"),
    ("sec", "sec=0.2:1"),
    ("agc", "agc=5ns"),
    ("envelope", "envelope"),
    ("crop", "crop=2ns..20ns"),
    ("resample", "resample=0.05ns"),
    ("normalise", "normalise=plate"),
    ("flip", "flip"),
];

impl std::str::FromStr for Chain {
    type Err = ParseError;

    fn from_str(text: &str) -> Result<Self, ParseError> {
        let written = text.split(',').map(str::trim).filter(|part| !part.is_empty());
        let steps = written.map(|part| Ok((read(part)?, part.to_string()))).collect::<Result<Vec<_>, ParseError>>()?;
        if steps.is_empty() { Err(ParseError::Empty) } else { Ok(Self { steps }) }
    }
}

fn read(step: &str) -> Result<Instruction, ParseError> {
    let (name, value) = step.split_once('=').map_or((step, None), |(name, value)| (name.trim(), Some(value.trim())));
    let Some(&(name, form)) =
        FORMS.iter().find(|(known, _)| *known == name || (*known == "normalise" && name == "normalize"))
    else {
        let near = FORMS.iter().map(|(known, _)| (strsim::jaro_winkler(known, name), *known));
        let nearest =
            near.filter(|(alike, _)| *alike > 0.75).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, known)| known);
        let known = FORMS.map(|(known, _)| known).join(", ");
        return Err(ParseError::Unknown { word: name.into(), nearest, known });
    };
    instruction(name, value).map_err(|reason| ParseError::Value { step: step.into(), reason, form })
}

fn instruction(name: &str, value: Option<&str>) -> Result<Instruction, String> {
    let needed = || value.filter(|value| !value.is_empty()).ok_or_else(|| "it needs a value".to_string());
    let none = |made: Instruction| match value {
        None => Ok(made),
        Some(_) => Err("it takes no value".to_string()),
    };
    Ok(match name {
        "dc" => none(Instruction::RemoveDc)?,
        "envelope" => none(Instruction::Envelope)?,
        "flip" => none(Instruction::Flip)?,
        "timezero" => Instruction::TimeZero(zero_at(needed()?)?),
        "dewow" => match parts(needed()?)? {
            (window, None | Some("mean")) => Instruction::Dewow(quantity(window)?, Running::Mean),
            (window, Some("median")) => Instruction::Dewow(quantity(window)?, Running::Median),
            (_, Some(other)) => return Err(format!("`{other}` is neither `mean` nor `median`")),
        },
        "bandpass" => {
            let (band, order) = parts(needed()?)?;
            let (from, to) = span::<Hertz>(band, "300MHz..1.5GHz")?;
            Instruction::Filter(Band::Pass(from, to), order_of(order)?)
        }
        "highpass" => {
            let (corner, order) = parts(needed()?)?;
            Instruction::Filter(Band::High(quantity(corner)?), order_of(order)?)
        }
        "lowpass" => {
            let (corner, order) = parts(needed()?)?;
            Instruction::Filter(Band::Low(quantity(corner)?), order_of(order)?)
        }
        "background" => Instruction::Background(value.filter(|value| *value != "all").map(whole).transpose()?),
        "stack" => {
            let (group, least) = value.map_or(Ok(("all", None)), parts)?;
            let group = (group != "all").then(|| whole(group)).transpose()?;
            Instruction::Stack(group, least.map(number).transpose()?)
        }
        "sec" => {
            let (rate, power) = parts(needed()?)?;
            Instruction::GainByTime(number(rate)?, power.map_or(Ok(0.0), number)?)
        }
        "agc" => Instruction::GainByLevel(quantity(needed()?)?),
        "crop" => {
            let (from, to) = span(needed()?, "2ns..20ns")?;
            Instruction::Crop(from, to)
        }
        "resample" => Instruction::Resample(quantity(needed()?)?),
        _ => Instruction::Normalise(match needed()? {
            "max" | "maximum" => NormaliseBy::Maximum,
            "direct" => NormaliseBy::DirectWave,
            "surface" => NormaliseBy::Surface,
            "plate" => NormaliseBy::Plate,
            other => return Err(format!("`{other}` is none of max, direct, surface, plate")),
        }),
    })
}

fn zero_at(value: &str) -> Result<ZeroAt, String> {
    Ok(match value.split_once(':') {
        Some(("plate", height)) => ZeroAt::Plate(quantity(height)?),
        Some(_) => return Err("only `plate` is followed by a colon, and the height".into()),
        None => match value {
            "direct" => ZeroAt::DirectWave,
            "first" => ZeroAt::FirstPeak,
            "surface" => ZeroAt::Surface,
            "plate" => return Err("`plate` needs the height of the antenna over it, for example `plate:0.43m`".into()),
            time => ZeroAt::Time(quantity(time)?),
        },
    })
}

fn parts(value: &str) -> Result<(&str, Option<&str>), String> {
    match value.split_once(':') {
        None => Ok((value, None)),
        Some((_, rest)) if rest.contains(':') => Err("there are two colons in it".into()),
        Some((first, rest)) => Ok((first.trim(), Some(rest.trim()))),
    }
}

fn span<T: std::str::FromStr<Err = crate::units::UnitError>>(value: &str, example: &str) -> Result<(T, T), String> {
    let (from, to) = value
        .split_once("..")
        .ok_or_else(|| format!("two values with `..` between them are needed, as in `{example}`"))?;
    Ok((quantity(from)?, quantity(to)?))
}

/// A quantity; of the reason only what is wrong, not the hint.
fn quantity<T: std::str::FromStr<Err = crate::units::UnitError>>(text: &str) -> Result<T, String> {
    text.trim().parse::<T>().map_err(|error| error.to_string().split("\n\n").next().unwrap_or_default().to_string())
}

fn number(text: &str) -> Result<f64, String> {
    text.trim().parse().ok().filter(|value: &f64| value.is_finite()).ok_or_else(|| format!("`{text}` is not a number"))
}

fn whole(text: &str) -> Result<usize, String> {
    text.trim().parse().map_err(|_| format!("`{text}` is not a whole number of traces"))
}

fn order_of(text: Option<&str>) -> Result<usize, String> {
    text.map_or(Ok(ORDER), |text| text.parse().map_err(|_| format!("`{text}` is not an order")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn steps_are_read_in_their_order() {
        let text = "timezero=plate:0.43m, dc, dewow = 3ns:median,bandpass=300MHz..1.5GHz, lowpass=2GHz:2, background, background=100, stack, stack=all:0.99, stack=10, sec=0.2:1, agc=5ns, envelope, crop=-1ns..20ns, normalise=plate, flip, resample=10ps";
        let chain: Chain = text.parse().unwrap();
        let steps: Vec<Instruction> = chain.steps.iter().map(|(step, _)| *step).collect();
        assert_eq!(
            steps,
            [
                Instruction::TimeZero(ZeroAt::Plate(Metres(0.43))),
                Instruction::RemoveDc,
                Instruction::Dewow(Seconds(3e-9), Running::Median),
                Instruction::Filter(Band::Pass(Hertz(300e6), Hertz(1.5e9)), 4),
                Instruction::Filter(Band::Low(Hertz(2e9)), 2),
                Instruction::Background(None),
                Instruction::Background(Some(100)),
                Instruction::Stack(None, None),
                Instruction::Stack(None, Some(0.99)),
                Instruction::Stack(Some(10), None),
                Instruction::GainByTime(0.2, 1.0),
                Instruction::GainByLevel(Seconds(5e-9)),
                Instruction::Envelope,
                Instruction::Crop(Seconds(-1e-9), Seconds(20e-9)),
                Instruction::Normalise(NormaliseBy::Plate),
                Instruction::Flip,
                Instruction::Resample(Seconds(10e-12)),
            ]
        );
        assert_eq!(chain.steps[2].1, "dewow = 3ns:median");
    }

    #[test]
    fn what_is_no_step_is_refused_word_for_word() {
        let message = |text: &str| text.parse::<Chain>().unwrap_err().to_string();
        assert_eq!(message("dewov=3ns"), "`dewov` is no step\n\nhint: did you mean `dewow`?");
        assert_eq!(
            message("xyz"),
            "`xyz` is no step: known are timezero, dc, dewow, bandpass, highpass, lowpass, background, stack, sec, agc, envelope, crop, resample, normalise, flip"
        );
        assert_eq!(
            message("dewow=3"),
            "`dewow=3` cannot be read: `3` has no unit: a time needs one of s, ms, us, µs, ns, ps\n\nhint: write it as `dewow=3ns`"
        );
        assert_eq!(
            message("bandpass"),
            "`bandpass` cannot be read: it needs a value\n\nhint: write it as `bandpass=300MHz..1.5GHz`"
        );
        assert!(message("bandpass=300MHz").contains("two values with `..` between them are needed"));
        assert!(message("flip=1").contains("it takes no value"));
        assert!(message("stack=ten").contains("`ten` is not a whole number of traces"));
        assert!(message("timezero=plate").contains("needs the height"));
        assert!(message("sec=nan").contains("`nan` is not a number"));
        assert_eq!(
            message(" , "),
            "there is no step in it\n\nhint: for example `dewow=3ns, bandpass=300MHz..1.5GHz, background`"
        );
    }

    /// The help and the reader know the same steps.
    #[test]
    fn the_help_names_every_step() {
        for (name, form) in FORMS {
            assert!(STEPS.iter().any(|(shown, _)| shown.contains(name)), "{name}");
            assert!(form.parse::<Chain>().is_ok(), "{form}");
        }
    }

    proptest! {
        #[test]
        fn garbage_never_panics(text in ".*", steps in "[a-z]{1,8}(=[-0-9.a-zA-Z:]{0,12})?(, ?[a-z]{2,9}=[0-9.:nsMHz]{0,9}){0,3}") {
            let _ = text.parse::<Chain>();
            let _ = steps.parse::<Chain>();
        }
    }
}
