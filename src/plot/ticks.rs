//! Ticks: round numbers along an axis and how they are written.

use super::axis::{Scale, Span};

/// The ticks of an axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Ticks {
    /// Share of the axis and label of every labelled tick.
    pub(super) major: Vec<(f64, String)>,
    /// Share of the axis of every tick without label.
    pub(super) minor: Vec<f64>,
    /// The power of ten taken out of the labels, written out; empty for none.
    pub(super) factor: String,
}

/// Chooses at most `most` labelled ticks (and at least two where the span allows it).
pub(super) fn choose(span: &Span, most: usize) -> Ticks {
    let most = most.clamp(2, 40);
    let mut ticks = match span.scale {
        Scale::Linear => linear(span.low, span.high, most),
        Scale::Log10 if span.high - span.low < 0.7 => within_a_decade(span, most),
        Scale::Log10 => decades(span, most),
    };
    let on_axis = |share: f64| (-1e-6..=1.0 + 1e-6).contains(&share);
    ticks.major.retain(|(share, _)| on_axis(*share));
    ticks.minor.retain(|share| on_axis(*share));
    ticks
}

/// The ticks asked for, as far as they lie on the axis.
pub(super) fn given(span: &Span, values: &[f64]) -> Ticks {
    let on_axis = |value: f64| span.share(value).filter(|share| (-1e-9..=1.0 + 1e-9).contains(share));
    let text = |value: f64| if value < 0.0 { format!("−{}", -value) } else { format!("{value}") };
    let mut major: Vec<_> = values.iter().filter_map(|&value| Some((on_axis(value)?, text(value + 0.0)))).collect();
    major.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ticks { major, ..Ticks::default() }
}

/// A step of 1, 2 or 5 times a power of ten, as (digit, exponent), that cuts the span into at most `most` parts.
fn round_step(span: f64, most: usize) -> (f64, i32) {
    let wanted = span / most as f64;
    let mut exponent = wanted.log10().floor() as i32;
    for digit in [1.0, 2.0, 5.0] {
        if digit * ten_to(exponent) >= wanted * (1.0 - 1e-9) {
            return (digit, exponent);
        }
    }
    exponent += 1;
    (1.0, exponent)
}

/// The step for an axis: the finest that fits, unless a coarser one that still gives four parts meets both ends.
fn step_for(low: f64, high: f64, most: usize) -> (f64, i32) {
    let finest = round_step(high - low, most);
    let meets = |end: f64, step: f64| (end / step - (end / step).round()).abs() < 1e-9;
    let next = |(digit, exponent): (f64, i32)| match digit {
        1.0 => (2.0, exponent),
        2.0 => (5.0, exponent),
        _ => (1.0, exponent + 1),
    };
    std::iter::successors(Some(finest), |&step| Some(next(step)))
        .map(|(digit, exponent)| ((digit, exponent), digit * ten_to(exponent)))
        .take_while(|(_, step)| (high - low) / step >= 4.0 - 1e-9)
        .take(4)
        .find(|(_, step)| meets(low, *step) && meets(high, *step))
        .map_or(finest, |found| found.0)
}

/// Multiples of the step from `low` to `high`, as multipliers.
fn multipliers(low: f64, high: f64, step: f64) -> impl Iterator<Item = f64> {
    let slack = (high - low) * 1e-9;
    let first = ((low - slack) / step).ceil();
    let count = (((high + slack) / step).floor() - first).clamp(-1.0, 100.0);
    (0..=count as i64).filter(move |_| count >= 0.0).map(move |k| first + k as f64)
}

fn linear(low: f64, high: f64, most: usize) -> Ticks {
    let (digit, exponent) = step_for(low, high, most);
    let step = digit * ten_to(exponent);
    let largest = low.abs().max(high.abs());
    let magnitude = largest.log10().floor() as i32;
    // Thousands are taken out of labels that would otherwise carry more than five digits before or three behind the point.
    let common = if !(-3..5).contains(&magnitude) { magnitude.div_euclid(3) * 3 } else { 0 };
    let decimals = (common - exponent).clamp(0, 15) as usize;
    let share = |value: f64| (value - low) / (high - low);
    let major = multipliers(low, high, step)
        .map(|k| (share(k * step), number(k * digit * ten_to(exponent - common), decimals)))
        .collect();
    let parts = if digit == 2.0 { 4.0 } else { 5.0 };
    let minor = multipliers(low, high, step / parts).map(|k| share(k * step / parts)).collect();
    Ticks { major, minor, factor: if common == 0 { String::new() } else { power_of_ten(common) } }
}

fn decades(span: &Span, most: usize) -> Ticks {
    let share = |log: f64| (log - span.low) / (span.high - span.low);
    let (first, last) = ((span.low - 1e-9).ceil() as i64, (span.high + 1e-9).floor() as i64);
    let stride = ((last - first + 1).max(1) as usize).div_ceil(most).max(1) as i64;
    let narrow = span.high - span.low;
    let labelled: &[f64] = if narrow < 1.6 && most >= 6 {
        &[1.0, 2.0, 5.0]
    } else if narrow < 2.5 && most >= 6 {
        &[1.0, 3.0]
    } else {
        &[1.0]
    };
    let mut ticks = Ticks::default();
    for decade in first - 1..=last {
        for digit in 1..10 {
            let log = decade as f64 + f64::from(digit).log10();
            if log < span.low - 1e-9 || log > span.high + 1e-9 {
                continue;
            }
            if labelled.contains(&f64::from(digit)) && decade.rem_euclid(stride) == 0 {
                ticks.major.push((share(log), scientific(f64::from(digit), decade as i32)));
            } else if stride == 1 || digit == 1 {
                ticks.minor.push(share(log));
            }
        }
    }
    if ticks.major.len() < 2 { within_a_decade(span, most) } else { ticks }
}

/// Ticks at round numbers on a logarithmic axis too short for powers of ten.
fn within_a_decade(span: &Span, most: usize) -> Ticks {
    // Beyond these powers the ends are no longer numbers of full precision.
    if span.low < -290.0 || span.high > 290.0 {
        return Ticks::default();
    }
    let (low, high) = (ten_to_real(span.low), ten_to_real(span.high));
    let plain = linear(low, high, most.min(6));
    let place = |share: f64| ((low + share * (high - low)).log10() - span.low) / (span.high - span.low);
    Ticks {
        major: plain.major.into_iter().map(|(share, label)| (place(share), label)).collect(),
        minor: plain.minor.into_iter().map(place).collect(),
        factor: plain.factor,
    }
}

fn ten_to(exponent: i32) -> f64 {
    ten_to_real(f64::from(exponent))
}

fn ten_to_real(exponent: f64) -> f64 {
    10f64.powf(exponent)
}

/// A number with fixed decimals, a true minus sign, and no minus before zero.
pub(super) fn number(value: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", value.abs());
    let is_zero = text.chars().all(|c| c == '0' || c == '.');
    if value < 0.0 && !is_zero { format!("−{text}") } else { text }
}

fn scientific(digit: f64, exponent: i32) -> String {
    match exponent {
        0..=4 => number(digit * ten_to(exponent), 0),
        -3..=-1 => number(digit * ten_to(exponent), exponent.unsigned_abs() as usize),
        _ if digit == 1.0 => power_of_ten(exponent),
        _ => format!("{digit}×{}", power_of_ten(exponent)),
    }
}

/// `10⁻³` and its like.
pub(super) fn power_of_ten(exponent: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised =
        exponent.to_string().chars().map(|c| c.to_digit(10).map_or('⁻', |d| DIGITS[d as usize])).collect::<String>();
    format!("10{raised}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64, most: usize) -> Vec<String> {
        choose(&Span { scale: Scale::Linear, low, high }, most).major.into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round_and_zero_has_no_sign() {
        assert_eq!(labels(0.0, 25.0, 6), ["0", "5", "10", "15", "20", "25"]);
        assert_eq!(labels(0.0, 25.0, 14), ["0", "5", "10", "15", "20", "25"]);
        assert_eq!(labels(-1.0, 1.0, 4), ["−1.0", "−0.5", "0.0", "0.5", "1.0"]);
        assert_eq!(labels(-0.3, 0.3, 6), ["−0.3", "−0.2", "−0.1", "0.0", "0.1", "0.2", "0.3"]);
        assert_eq!(number(-0.04, 1), "0.0");
    }

    #[test]
    fn tiny_and_huge_numbers_share_a_power_of_ten() {
        let ticks = choose(&Span { scale: Scale::Linear, low: 0.0, high: 4e-6 }, 4);
        assert_eq!(ticks.factor, "10⁻⁶");
        assert_eq!(ticks.major.iter().map(|t| t.1.as_str()).collect::<Vec<_>>(), ["0", "1", "2", "3", "4"]);
        assert_eq!(choose(&Span { scale: Scale::Linear, low: 0.0, high: 3e8 }, 3).factor, "10⁶");
    }

    /// The ends of such axes are beyond the numbers; a tick of them would lie far off the sheet.
    #[test]
    fn extreme_logarithmic_axes_have_no_ticks_off_the_axis() {
        for (low, high) in [(-307.9, -307.5), (299.6, 300.4), (-310.0, 312.0), (-0.01, 0.02)] {
            let ticks = choose(&Span { scale: Scale::Log10, low, high }, 8);
            let shares = ticks.major.iter().map(|t| t.0).chain(ticks.minor);
            assert!(shares.clone().all(|share| (-1e-6..=1.000_001).contains(&share)), "{low} to {high}");
        }
    }

    #[test]
    fn sieves_are_ticks_where_they_lie_on_the_axis() {
        let span = Span { scale: Scale::Log10, low: 1.0, high: 2.0 };
        let ticks = given(&span, &[63.0, 22.4, 31.5, 125.0, 0.0]);
        assert_eq!(ticks.major.iter().map(|t| t.1.as_str()).collect::<Vec<_>>(), ["22.4", "31.5", "63"]);
        assert!((ticks.major[0].0 - 22.4_f64.log10() + 1.0).abs() < 1e-12);
    }

    #[test]
    fn decades_are_labelled_and_their_parts_marked() {
        let ticks = choose(&Span { scale: Scale::Log10, low: -5.0, high: 1.0 }, 8);
        let text: Vec<_> = ticks.major.iter().map(|t| t.1.as_str()).collect();
        assert_eq!(text, ["10⁻⁵", "10⁻⁴", "0.001", "0.01", "0.1", "1", "10"]);
        assert_eq!(ticks.minor.len(), 6 * 8);
        let short = choose(&Span { scale: Scale::Log10, low: 1.35, high: 1.82 }, 8);
        assert!(short.major.len() >= 3, "{short:?}");
    }
}
