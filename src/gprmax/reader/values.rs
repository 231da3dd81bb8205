//! The parameters of one command.

use super::error::Problem;
use super::lines::Command;

/// The words behind a command, read one after the other.
pub(super) struct Parameters<'a> {
    command: &'a str,
    form: &'static str,
    words: Vec<&'a str>,
}

impl<'a> Parameters<'a> {
    /// Splits the parameters and checks how many there are.
    pub fn of(command: &Command<'a>, form: &'static str, allowed: impl Fn(usize) -> bool) -> Result<Self, Problem> {
        let words: Vec<_> = command.parameters.split_whitespace().collect();
        if !allowed(words.len()) {
            return Err(Problem::Parameters { command: command.name.into(), found: words.len(), form });
        }
        Ok(Self { command: command.name, form, words })
    }

    /// Name of the command, without `#`.
    pub fn command(&self) -> &'a str {
        self.command
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.words.len()
    }

    /// The word at `index`.
    pub fn word(&self, index: usize) -> Result<&'a str, Problem> {
        let found = self.words.len();
        let missing = || Problem::Parameters { command: self.command.into(), found, form: self.form };
        self.words.get(index).copied().ok_or_else(missing)
    }

    /// The words from `index` on.
    pub fn rest(&self, index: usize) -> &[&'a str] {
        self.words.get(index..).unwrap_or(&[])
    }

    /// A number, also an infinite one, but never "not a number".
    pub fn number_or_infinity(&self, index: usize, what: &'static str) -> Result<f64, Problem> {
        let text = self.word(index)?;
        match text.parse::<f64>() {
            Ok(value) if !value.is_nan() => Ok(value),
            _ => Err(Problem::NotANumber { command: self.command.into(), text: text.into(), what }),
        }
    }

    /// A finite number.
    pub fn number(&self, index: usize, what: &'static str) -> Result<f64, Problem> {
        let value = self.number_or_infinity(index, what)?;
        self.check(what, value, value.is_finite(), "finite")
    }

    /// A point in metres.
    pub fn point(&self, index: usize) -> Result<[f64; 3], Problem> {
        Ok([
            self.number(index, "the x coordinate in metres")?,
            self.number(index + 1, "the y coordinate in metres")?,
            self.number(index + 2, "the z coordinate in metres")?,
        ])
    }

    /// A whole number from zero up.
    pub fn count(&self, index: usize, what: &'static str) -> Result<usize, Problem> {
        let text = self.word(index)?;
        text.parse().map_err(|_| Problem::NotANumber { command: self.command.into(), text: text.into(), what })
    }

    /// `y` or `n` in either case.
    pub fn yes_or_no(&self, index: usize, what: &'static str) -> Result<bool, Problem> {
        let text = self.word(index)?;
        match text {
            "y" | "Y" => Ok(true),
            "n" | "N" => Ok(false),
            _ => Err(self.not_one_of(text, what, "y, n".into())),
        }
    }

    /// Passes a value on if it is allowed.
    pub fn check(&self, what: &'static str, value: f64, allowed: bool, limit: &'static str) -> Result<f64, Problem> {
        if allowed { Ok(value) } else { Err(Problem::OutOfRange { command: self.command.into(), what, value, limit }) }
    }

    /// The error about a word that is none of those allowed.
    pub fn not_one_of(&self, text: &str, what: &'static str, known: String) -> Problem {
        Problem::Word { command: self.command.into(), text: text.into(), what, known }
    }

    /// The error about a form of the command that is not supported.
    pub fn unsupported(&self, what: &'static str) -> Problem {
        Problem::UnsupportedForm { command: self.command.into(), what }
    }
}
