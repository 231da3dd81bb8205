//! Reading traces from columns of text: digitised figures, exports of other programs.
//!
//! One line per sample: the time, then one or more columns of amplitude, separated by commas, semicolons, spaces or tabs.
//! Where a line has semicolons, a comma is a decimal comma. `#`, `%`, `//` and `!` start comments; the first line may name
//! the columns.
//!
//! **Unit of time.** If the name of the first column has the word `s`, `ms`, `us`, `ns` or `ps` (as in `t_ns`, `time [s]`,
//! `Time/ps`), that; else the last comment before the data that has one of them in brackets. Else by size: if every time is
//! below 1 ms as seconds (1e-3), they are seconds; larger numbers are nanoseconds.
//!
//! **Time axis.** Evenly spaced to 1 % of a step, or to the digits written: taken as even. Up to a quarter of a step off: a
//! cubic spline puts the samples on an even axis. Beyond that the line is named and refused, unless
//! [`TextOptions::resample`] gives a step for the spline, as digitised curves need.

use crate::trace::{AScan, Component};
use crate::units::Seconds;

/// Which column of amplitude is read.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Column {
    /// The first after the time.
    #[default]
    First,
    /// The one of this name in the header.
    Named(String),
    /// Counted from 1 over all columns, so the first after the time is 2.
    Number(usize),
}

/// How a file of text is read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TextOptions {
    /// Which column of amplitude.
    pub column: Column,
    /// Step of the even time axis onto which any rising times are brought by a cubic spline.
    pub resample: Option<Seconds>,
}

/// Why a text is not a trace. Lines are counted from 1.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TextError {
    /// No numbers.
    #[error("`{name}` holds no samples\n\nhint: write a time and an amplitude on each line, for example `0.01, -0.25`")]
    NoSamples {
        /// Name of the text.
        name: String,
    },
    /// One sample.
    #[error("`{name}` holds one sample: at least two are needed")]
    OneSample {
        /// Name of the text.
        name: String,
    },
    /// Something that is no number.
    #[error("line {line} of `{name}`: `{field}` is not a number")]
    NotANumber {
        /// Name of the text.
        name: String,
        /// Line.
        line: usize,
        /// What stands there.
        field: String,
    },
    /// Too few columns.
    #[error("line {line} of `{name}` has {found} columns: column {wanted} is needed")]
    TooFewColumns {
        /// Name of the text.
        name: String,
        /// Line.
        line: usize,
        /// Columns found.
        found: usize,
        /// Column needed, counted from 1.
        wanted: usize,
    },
    /// A column that is not there.
    #[error("`{name}` has no column `{column}`\n\nhint: its columns are {known}")]
    NoSuchColumn {
        /// Name of the text.
        name: String,
        /// The column asked for.
        column: String,
        /// Those that are there.
        known: String,
    },
    /// Time that stands or goes back.
    #[error("line {line} of `{name}`: time {time} does not come after {before}")]
    TimeNotRising {
        /// Name of the text.
        name: String,
        /// Line.
        line: usize,
        /// Time there, as written.
        time: f64,
        /// Time before, as written.
        before: f64,
    },
    /// Times that are not evenly spaced.
    #[error(
        "line {line} of `{name}`: time {time} should be {expected:.6} for an even step of {step:.6}\n\nhint: give a step to resample to, for example 0.01 ns"
    )]
    Uneven {
        /// Name of the text.
        name: String,
        /// Line.
        line: usize,
        /// Time there, as written.
        time: f64,
        /// Time that an even axis would have there.
        expected: f64,
        /// Mean step, in the unit of the text.
        step: f64,
    },
    /// A step to resample to that gives no or too many samples.
    #[error("a step of {step} makes {samples:.0} samples of `{name}`: it should make 2 to 10000000")]
    ResampleStep {
        /// Name of the text.
        name: String,
        /// The step.
        step: Seconds,
        /// Samples that it makes.
        samples: f64,
    },
}

/// One line of numbers.
struct Row {
    line: usize,
    time: f64,
    amplitude: f64,
}

/// Share of a step by which times may be off and still count as even.
const EVEN: f64 = 0.01;
/// Share of a step up to which uneven times are brought onto an even axis unasked.
const SMALL_JITTER: f64 = 0.25;
/// Below this, times without a unit are seconds.
const SECONDS_BELOW: f64 = 1e-3;

/// Reads a trace from text, by the rules of this module.
///
/// `name` is for messages and becomes the name of the trace.
///
/// ```
/// use ballast_gpr::compare::text::{read_trace, TextOptions};
/// let trace = read_trace("time [ns], Ez\n0.0, 0\n0.5, 1\n1.0, -1\n", "figure 9", &TextOptions::default())?;
/// assert_eq!((trace.time_step.si(), trace.samples.len()), (0.5e-9, 3));
/// # Ok::<(), ballast_gpr::compare::text::TextError>(())
/// ```
///
/// # Errors
/// No or one sample, what is no number (with its line), a column that is not there, times that do not rise or are uneven.
pub fn read_trace(text: &str, name: &str, options: &TextOptions) -> Result<AScan, TextError> {
    Table::read(text, name, Some(&options.column))?.trace(0, name, options.resample)
}

/// Reads every column of amplitude as a trace, all on the time axis of the first column.
///
/// The first line of numbers tells how many columns there are; each trace has the name of the text.
///
/// # Errors
/// As [`read_trace`].
pub fn read_traces(text: &str, name: &str, resample: Option<Seconds>) -> Result<Vec<AScan>, TextError> {
    let table = Table::read(text, name, None)?;
    (0..table.width).map(|column| table.trace(column, name, resample)).collect()
}

/// What a text holds: a time in each line, and as many amplitudes as are wanted.
struct Table {
    /// Line and time.
    times: Vec<(usize, f64)>,
    /// Amplitudes to a line.
    width: usize,
    /// Amplitudes, line by line.
    values: Vec<f64>,
    /// Unit of the times, s.
    unit: f64,
    /// Most decimals that a time has.
    decimals: i32,
}

impl Table {
    /// Reads the column of this name or number, or all behind the first.
    fn read(text: &str, name: &str, choice: Option<&Column>) -> Result<Self, TextError> {
        let text = text.trim_start_matches('\u{feff}');
        let mut header: Option<Vec<String>> = None;
        let mut comment_unit = None;
        let mut times: Vec<(usize, f64)> = vec![];
        let mut values = vec![];
        let mut columns = match choice {
            None | Some(Column::First) => Some(1..2),
            Some(Column::Number(number)) => Some(number.saturating_sub(1)..number.saturating_sub(1) + 1),
            Some(Column::Named(_)) => None,
        };
        let mut decimals = 0;
        for (index, raw) in text.lines().enumerate() {
            let line = index + 1;
            let (content, comment) = split_comment(raw);
            if times.is_empty() && header.is_none() {
                comment_unit = comment.and_then(bracketed_unit).or(comment_unit);
            }
            let fields = split_fields(content);
            if fields.is_empty() {
                continue;
            }
            if times.is_empty() && header.is_none() && fields.iter().all(|f| f.parse::<f64>().is_err()) {
                let named = choice.and_then(|column| named_column(column, &fields));
                columns = columns.or_else(|| named.map(|at| at..at + 1));
                header = Some(fields);
                continue;
            }
            if choice.is_none() && times.is_empty() {
                columns = Some(1..fields.len().max(2));
            }
            let Some(wanted) = columns.clone() else { return Err(no_such_column(name, choice, header.as_deref())) };
            let (Some(time), Some(amplitudes)) = (fields.first(), fields.get(wanted.clone())) else {
                let found = fields.len();
                return Err(TextError::TooFewColumns { name: name.into(), line, found, wanted: wanted.end });
            };
            let number = |field: &String| {
                let parsed = field.parse::<f64>().ok().filter(|v| v.is_finite());
                parsed.ok_or_else(|| TextError::NotANumber {
                    name: name.into(),
                    line,
                    field: field.chars().take(40).collect(),
                })
            };
            decimals = decimals.max(decimals_written(time));
            times.push((line, number(time)?));
            for amplitude in amplitudes {
                values.push(number(amplitude)?);
            }
        }
        match times.len() {
            0 if columns.is_none() => return Err(no_such_column(name, choice, header.as_deref())),
            0 => return Err(TextError::NoSamples { name: name.into() }),
            1 => return Err(TextError::OneSample { name: name.into() }),
            _ => {}
        }
        let header_unit = header.as_ref().and_then(|h| h.first()).and_then(|first| unit_word(first));
        let largest = times.iter().fold(0.0_f64, |m, (_, time)| m.max(time.abs()));
        let by_size = if largest < SECONDS_BELOW { 1.0 } else { 1e-9 };
        let unit = header_unit.or(comment_unit).unwrap_or(by_size);
        Ok(Self { width: values.len() / times.len(), times, values, unit, decimals })
    }

    /// The trace in one of its columns of amplitude.
    fn trace(&self, column: usize, name: &str, resample: Option<Seconds>) -> Result<AScan, TextError> {
        let amplitudes = self.values.iter().skip(column).step_by(self.width.max(1));
        let row = |(&(line, time), &amplitude): (&(usize, f64), &f64)| Row { line, time, amplitude };
        let rows: Vec<Row> = self.times.iter().zip(amplitudes).map(row).collect();
        let (first, step, samples) = onto_even_axis(&rows, self.decimals, self.unit, name, resample)?;
        Ok(AScan {
            samples,
            time_step: Seconds(step),
            first_sample: Seconds(first),
            component: Component::Recorded,
            position: None,
            name: name.into(),
        })
    }
}

/// First time and step in s, and the samples.
fn onto_even_axis(
    rows: &[Row],
    decimals: i32,
    unit: f64,
    name: &str,
    resample: Option<Seconds>,
) -> Result<(f64, f64, Vec<f64>), TextError> {
    for pair in rows.windows(2) {
        if pair[1].time <= pair[0].time {
            let (line, time, before) = (pair[1].line, pair[1].time, pair[0].time);
            return Err(TextError::TimeNotRising { name: name.into(), line, time, before });
        }
    }
    let (first, last) = (rows[0].time, rows[rows.len() - 1].time);
    if let Some(wished) = resample {
        let samples = ((last - first) * unit / wished.si() + 1e-9).floor() + 1.0;
        if !(2.0..=1e7).contains(&samples) {
            return Err(TextError::ResampleStep { name: name.into(), step: wished, samples });
        }
        let step = wished.si() / unit;
        return Ok((scaled(first, unit), wished.si(), spline(rows, first, step, samples as usize)));
    }
    let (per_unit, quantum) = (10_f64.powi(decimals), 10_f64.powi(-decimals));
    let mean_step = (last - first) / (rows.len() - 1) as f64;
    // A step that was written with these digits is taken with these digits: 24.99/2499 is 0.01, not the number after it.
    let written_step = (mean_step * per_unit).round() / per_unit;
    let same = (written_step - mean_step).abs() * rows.len() as f64 <= 1e-9 * mean_step;
    let step = if same { written_step } else { mean_step };
    let expected = |k: usize| first + k as f64 * step;
    let off = |k: usize| (rows[k].time - expected(k)).abs() / step;
    let worst = (0..rows.len()).map(off).fold(0.0, f64::max);
    let written = if quantum <= SMALL_JITTER * step { 1.001 * quantum / step } else { 0.0 };
    if worst <= EVEN.max(written) {
        return Ok((scaled(first, unit), scaled(step, unit), rows.iter().map(|row| row.amplitude).collect()));
    }
    if worst <= SMALL_JITTER {
        return Ok((scaled(first, unit), scaled(step, unit), spline(rows, first, step, rows.len())));
    }
    let k = (0..rows.len()).find(|k| off(*k) > SMALL_JITTER).unwrap_or(0);
    let (line, time) = (rows[k].line, rows[k].time);
    Err(TextError::Uneven { name: name.into(), line, time, expected: expected(k), step })
}

/// `value * unit` with the decimal point moved before rounding, so that 0.01 ns is the number nearest to 1e-11 s.
fn scaled(value: f64, unit: f64) -> f64 {
    let power = unit.log10().round() as i32;
    let text = format!("{value:e}");
    let moved = text.split_once('e').and_then(|(mantissa, exponent)| {
        let exponent: i32 = exponent.parse().ok()?;
        format!("{mantissa}e{}", exponent + power).parse().ok()
    });
    moved.unwrap_or(value * unit)
}

/// Natural cubic spline through the rows, at `count` times from `first` every `step`.
fn spline(rows: &[Row], first: f64, step: f64, count: usize) -> Vec<f64> {
    let n = rows.len();
    let gap = |k: usize| rows[k + 1].time - rows[k].time;
    let slope = |k: usize| (rows[k + 1].amplitude - rows[k].amplitude) / gap(k);
    // Second derivatives by elimination of the tridiagonal system.
    let (mut above, mut bend) = (vec![0.0; n], vec![0.0; n]);
    for k in 1..n - 1 {
        let pivot = 2.0 * (gap(k - 1) + gap(k)) - gap(k - 1) * above[k - 1];
        above[k] = gap(k) / pivot;
        bend[k] = (6.0 * (slope(k) - slope(k - 1)) - gap(k - 1) * bend[k - 1]) / pivot;
    }
    for k in (1..n - 1).rev() {
        bend[k] -= above[k] * bend[k + 1];
    }
    let mut interval = 0;
    (0..count)
        .map(|index| {
            let t = first + index as f64 * step;
            while interval + 2 < n && rows[interval + 1].time < t {
                interval += 1;
            }
            let h = gap(interval);
            let (left, right) = ((rows[interval + 1].time - t) / h, (t - rows[interval].time) / h);
            left * rows[interval].amplitude
                + right * rows[interval + 1].amplitude
                + ((left.powi(3) - left) * bend[interval] + (right.powi(3) - right) * bend[interval + 1]) * h * h / 6.0
        })
        .collect()
}

fn split_comment(line: &str) -> (&str, Option<&str>) {
    let start = ["#", "%", "//", "!"].iter().filter_map(|mark| line.find(mark)).min();
    start.map_or((line, None), |at| (&line[..at], Some(&line[at..])))
}

fn split_fields(line: &str) -> Vec<String> {
    let fields: Vec<String> = if line.contains(';') {
        line.split(';').map(|f| f.trim().replace(',', ".")).collect()
    } else if line.contains(',') {
        line.split(',').map(|f| f.trim().to_string()).collect()
    } else if line.contains('\t') {
        line.split('\t').map(|f| f.trim().to_string()).collect()
    } else {
        line.split_whitespace().map(str::to_string).collect()
    };
    let mut fields: Vec<String> = fields.into_iter().map(|f| f.trim_matches('"').trim().to_string()).collect();
    while fields.last().is_some_and(String::is_empty) {
        fields.pop();
    }
    fields
}

fn named_column(column: &Column, header: &[String]) -> Option<usize> {
    match column {
        Column::Named(wanted) => header.iter().position(|field| field == wanted),
        Column::First | Column::Number(_) => None,
    }
}

fn no_such_column(name: &str, column: Option<&Column>, header: Option<&[String]>) -> TextError {
    let known = header.map_or_else(
        || "not named: the file has no header, so give a number".to_string(),
        |fields| fields.iter().skip(1).map(|f| format!("`{f}`")).collect::<Vec<_>>().join(", "),
    );
    let column = match column {
        Some(Column::Named(wanted)) => wanted.clone(),
        Some(Column::First) | None => "2".into(),
        Some(Column::Number(number)) => number.to_string(),
    };
    TextError::NoSuchColumn { name: name.into(), column, known }
}

/// Size in s of the first word of a text that is a unit of time.
fn unit_word(text: &str) -> Option<f64> {
    text.split(|c: char| !c.is_alphanumeric()).find_map(|word| match word {
        "s" | "sec" | "seconds" => Some(1.0),
        "ms" => Some(1e-3),
        "us" | "µs" => Some(1e-6),
        "ns" | "nanoseconds" => Some(1e-9),
        "ps" => Some(1e-12),
        _ => None,
    })
}

/// Unit in brackets, as in `# time [ns]`.
fn bracketed_unit(comment: &str) -> Option<f64> {
    comment.split(['[', '(']).skip(1).find_map(|rest| {
        let inside = rest.split([']', ')']).next()?.trim();
        if inside.contains(char::is_whitespace) { None } else { unit_word(inside) }
    })
}

/// Digits after the point of a number as written; an exponent counts.
fn decimals_written(field: &str) -> i32 {
    let lower = field.to_ascii_lowercase();
    let (mantissa, exponent) = lower.split_once('e').unwrap_or((&lower, "0"));
    let fraction = mantissa.split_once('.').map_or(0, |(_, digits)| digits.len().min(300) as i32);
    (fraction - exponent.parse::<i32>().unwrap_or(0).clamp(-300, 300)).clamp(-300, 300)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn read(text: &str) -> Result<AScan, TextError> {
        read_trace(text, "x.txt", &TextOptions::default())
    }

    fn message(text: &str) -> String {
        read(text).unwrap_err().to_string()
    }

    #[test]
    fn separators_headers_and_units() {
        for text in [
            "0 1\n0.5 2\n1 3",
            "# any comment\n0,1\n0.5,2\n1,3\n",
            "\u{feff}time;value\r\n0,0;1\r\n0,5;2,0\r\n1;3",
            "t_ns\tEz\n0\t1\n0.5\t2\n1\t3 # end\n\n",
            "time (ps), a\n0, 1\n500, 2\n1000, 3",
            "\"time [s]\", \"a\"\n0, 1\n5e-10, 2\n1e-9, 3",
            "# time [us]\n0, 1\n5e-4, 2\n1e-3, 3",
            "0 1\n5e-10 2\n1e-9 3",
        ] {
            let trace = read(text).unwrap();
            assert_eq!(trace.samples, [1.0, 2.0, 3.0], "{text}");
            assert!((trace.time_step.si() / 0.5e-9 - 1.0).abs() < 1e-12, "{text}: {}", trace.time_step);
        }
    }

    #[test]
    fn columns_by_name_and_number() {
        let text = "t_ns,first,second\n0,1,10\n1,2,20\n";
        let with = |column| read_trace(text, "x.txt", &TextOptions { column, resample: None });
        assert_eq!(with(Column::Named("second".into())).unwrap().samples, [10.0, 20.0]);
        assert_eq!(with(Column::Number(3)).unwrap().samples, [10.0, 20.0]);
        assert_eq!(
            with(Column::Named("third".into())).unwrap_err().to_string(),
            "`x.txt` has no column `third`\n\nhint: its columns are `first`, `second`"
        );
        assert_eq!(
            with(Column::Number(4)).unwrap_err().to_string(),
            "line 2 of `x.txt` has 3 columns: column 4 is needed"
        );
    }

    #[test]
    fn every_column_is_a_trace() {
        let traces = read_traces("t_ns,a,b,c\n0,1,10,100\n1,2,20,200\n", "x.csv", None).unwrap();
        let samples: Vec<_> = traces.iter().map(|trace| trace.samples.clone()).collect();
        assert_eq!(samples, [[1.0, 2.0], [10.0, 20.0], [100.0, 200.0]]);
        let error = read_traces("0 1 2\n1 2 3\n2 3\n", "x.csv", None).unwrap_err().to_string();
        assert_eq!(error, "line 3 of `x.csv` has 2 columns: column 3 is needed");
    }

    #[test]
    fn messages_word_for_word() {
        assert_eq!(
            message("# nothing\n"),
            "`x.txt` holds no samples\n\nhint: write a time and an amplitude on each line, for example `0.01, -0.25`"
        );
        assert_eq!(message("0 1"), "`x.txt` holds one sample: at least two are needed");
        assert_eq!(message("0 1\n1 two"), "line 2 of `x.txt`: `two` is not a number");
        assert_eq!(message("0 1\n1 nan"), "line 2 of `x.txt`: `nan` is not a number");
        assert_eq!(message("0 1\n1 2\n1 3"), "line 3 of `x.txt`: time 1 does not come after 1");
        assert_eq!(
            message("t_ns v\n0 1\n1 2\n4 3\n6 4"),
            "line 3 of `x.txt`: time 1 should be 2.000000 for an even step of 2.000000\n\nhint: give a step to resample to, for example 0.01 ns"
        );
        let options = TextOptions { resample: Some(Seconds(1.0)), ..Default::default() };
        assert_eq!(
            read_trace("0 1\n1 2", "x.txt", &options).unwrap_err().to_string(),
            "a step of 1000000000 ns makes 1 samples of `x.txt`: it should make 2 to 10000000"
        );
    }

    /// 25 ns in 512 samples is 0.048828 ns; written with two digits the times are up to 10 % of a step off, and that is how
    /// they are written, not when they were taken.
    #[test]
    fn rounded_times_count_as_even() {
        let text: String = (0..512).map(|k| format!("{:.2} {k}\n", f64::from(k) * 25.0 / 512.0)).collect();
        let trace = read(&text).unwrap();
        assert!(trace.samples.iter().enumerate().all(|(k, v)| *v == k as f64));
        assert!((trace.time_step.si() * 512e9 - 25.0).abs() < 0.01);
    }

    /// A digitised sine with times up to a fifth of a step off, and one at random times: the spline gives it back to 1e-3
    /// (5/384 of the fourth power of the largest gap, 0.2 rad, is 2e-5).
    #[test]
    fn jittered_and_digitised_times_are_splined() {
        let jitter = |k: i32| 0.19 * f64::from(k * k * 7919 % 101 - 50) / 50.0;
        let inner = |k: i32| if k == 0 || k == 99 { 0.0 } else { jitter(k) };
        let text: String =
            (0..100).map(|k| (f64::from(k) + inner(k)) * 0.1).map(|t| format!("{t:.9} {:.9}\n", t.sin())).collect();
        let trace = read(&text).unwrap();
        assert!(trace.times().zip(&trace.samples).all(|(t, v)| (v - (t * 1e9).sin()).abs() < 1e-3));
        let text: String = (0..100)
            .map(|k| f64::from(k) + 4.0 * inner(k) / 2.0)
            .map(|k| k * 0.1)
            .map(|t| format!("{t:.9} {:.9}\n", t.sin()))
            .collect();
        assert!(matches!(read(&text), Err(TextError::Uneven { .. })));
        let options = TextOptions { resample: Some(Seconds(0.05e-9)), ..Default::default() };
        let trace = read_trace(&text, "x", &options).unwrap();
        assert_eq!(trace.samples.len(), 199);
        assert!(trace.times().zip(&trace.samples).all(|(t, v)| (v - (t * 1e9).sin()).abs() < 1e-3));
    }

    proptest! {
        #[test]
        fn garbage_never_panics(text in ".*", lines in prop::collection::vec("[-0-9eE.,; \t#a-z]{0,20}", 0..20)) {
            let _ = read(&text);
            let _ = read(&lines.join("\n"));
            let options = TextOptions { column: Column::Number(0), resample: Some(Seconds(1e-12)) };
            let _ = read_trace(&lines.join("\n"), "x", &options);
        }

        /// What is written with all its digits is read back.
        #[test]
        fn written_traces_read_back(samples in prop::collection::vec(-1e3..1e3_f64, 2..50), step in 1e-3..1.0_f64) {
            let text: String = samples.iter().enumerate().map(|(k, v)| format!("{} {v}\n", k as f64 * step)).collect();
            let trace = read(&format!("t_ns v\n{text}")).unwrap();
            prop_assert_eq!(&trace.samples, &samples);
            prop_assert!((trace.time_step.si() / (step * 1e-9) - 1.0).abs() < 1e-9);
        }
    }
}
