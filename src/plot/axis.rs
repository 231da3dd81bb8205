//! Axes: what they say, what they span, and where a value falls on them.

/// How values are spaced along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// By their decimal logarithm; values of zero and below are not shown.
    Log10,
}

/// An axis of a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What it shows, for example `time`.
    pub label: String,
    /// The unit of its numbers, for example `ns`; empty for none.
    pub unit: String,
    /// How values are spaced.
    pub scale: Scale,
    /// From where to where; `None`, an empty range or one that is not finite take it from the data.
    pub range: Option<(f64, f64)>,
    /// The labelled ticks, for example the sieves of a standard; empty to choose round numbers. Of labels that would
    /// touch, the first is written.
    pub ticks: Vec<f64>,
    /// Whether a vertical axis grows downwards, as the time of a radargram does.
    pub downwards: bool,
}

impl Axis {
    /// Makes a linear axis that spans its data.
    pub fn linear(label: &str, unit: &str) -> Self {
        Self {
            label: label.into(),
            unit: unit.into(),
            scale: Scale::Linear,
            range: None,
            ticks: Vec::new(),
            downwards: false,
        }
    }

    /// Makes a logarithmic axis that spans its data.
    pub fn log10(label: &str, unit: &str) -> Self {
        Self { scale: Scale::Log10, ..Self::linear(label, unit) }
    }

    /// The same axis with a fixed range.
    #[must_use]
    pub fn between(mut self, low: f64, high: f64) -> Self {
        self.range = Some((low, high));
        self
    }

    /// The same axis growing downwards, if it is a vertical one.
    #[must_use]
    pub fn downwards(mut self) -> Self {
        self.downwards = true;
        self
    }

    /// Label and unit as written beside the axis; `factor` is the power of ten taken out of the tick labels.
    pub(super) fn caption(&self, factor: &str) -> String {
        let unit = match (factor, self.unit.as_str()) {
            ("", "") => return self.label.clone(),
            ("", unit) => unit.to_owned(),
            (factor, "") => format!("×{factor}"),
            (factor, unit) => format!("×{factor} {unit}"),
        };
        if self.label.is_empty() { unit } else { format!("{} ({unit})", self.label) }
    }
}

/// Largest magnitude that is drawn as it is: sums and differences of such values stay finite.
const LARGEST: f64 = 1e300;

/// Smallest magnitude that counts as different from zero.
const SMALLEST: f64 = 1e-280;

/// Share of its magnitude below which a span is taken for a constant: finer ticks could not be told apart.
const NARROWEST: f64 = 1e-10;

/// The span of an axis, and the map from values to shares of its length. Internal values are logarithms on a
/// logarithmic axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Span {
    pub(super) scale: Scale,
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Span {
    /// The span of an axis over the data on it; `margin` is the share added at either end when the data decide.
    pub(super) fn of(axis: &Axis, values: impl Iterator<Item = f64>, margin: f64) -> Self {
        let scale = axis.scale;
        if let Some((a, b)) = axis.range {
            let inner = [a, b].map(|v| inner(scale, v));
            if let [Some(a), Some(b)] = inner
                && (b - a).abs() > NARROWEST * a.abs().max(b.abs()).max(SMALLEST)
            {
                return Self { scale, low: a.min(b), high: a.max(b) };
            }
        }
        let (low, high) = values
            .filter_map(|v| inner(scale, v))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        if low > high {
            return Self { scale, low: 0.0, high: 1.0 };
        }
        let span = high - low;
        if span <= NARROWEST * low.abs().max(high.abs()).max(SMALLEST) {
            let half = match scale {
                Scale::Log10 => 0.5,
                Scale::Linear if low.abs() < SMALLEST => 1.0,
                Scale::Linear => low.abs() * 0.1,
            };
            return Self { scale, low: low - half, high: high + half };
        }
        Self { scale, low: low - margin * span, high: high + margin * span }
    }

    /// Where a value falls: 0 at the low end, 1 at the high end; `None` if it has no place on this axis.
    pub(super) fn share(&self, value: f64) -> Option<f64> {
        inner(self.scale, value).map(|v| ((v - self.low) / (self.high - self.low)).clamp(-1e6, 1e6))
    }
}

fn inner(scale: Scale, value: f64) -> Option<f64> {
    match scale {
        Scale::Linear => (!value.is_nan()).then(|| value.clamp(-LARGEST, LARGEST)),
        Scale::Log10 => (value > 0.0).then(|| value.clamp(f64::MIN_POSITIVE, LARGEST).log10()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_series_gets_room_around_it() {
        let axis = Axis::linear("", "");
        assert!((Span::of(&axis, [2.0, 2.0].into_iter(), 0.05).share(2.0).unwrap() - 0.5).abs() < 1e-12);
        assert_eq!(Span::of(&axis, [0.0].into_iter(), 0.05), Span { scale: Scale::Linear, low: -1.0, high: 1.0 });
        assert_eq!(Span::of(&axis, [f64::NAN].into_iter(), 0.05).share(0.25), Some(0.25));
    }

    #[test]
    fn a_logarithmic_axis_has_no_place_for_zero() {
        let span = Span::of(&Axis::log10("", ""), [1e-3, 1e3, 0.0, -5.0].into_iter(), 0.0);
        assert!((span.share(1.0).unwrap() - 0.5).abs() < 1e-12);
        assert_eq!(span.share(0.0), None);
        assert_eq!(span.share(-1.0), None);
    }

    #[test]
    fn the_unit_and_the_factor_stand_in_the_caption() {
        assert_eq!(Axis::linear("time", "ns").caption(""), "time (ns)");
        assert_eq!(Axis::linear("Ez", "V/m").caption("10⁻³"), "Ez (×10⁻³ V/m)");
        assert_eq!(Axis::linear("amplitude", "").caption(""), "amplitude");
    }
}
