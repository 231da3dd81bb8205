//! Height of the fouling from the delay through the bed, with the uncertainty that the packing gives it.

use crate::forward::{Forward, OnProgress};
use crate::scene::{self, FoulingAmount, FoulingSpec, SceneSpec};
use crate::units::{Metres, Seconds};

use super::bias::BiasError;
use super::echoes::{EchoError, plate_reference, simulate_echoes};
use super::statistics::MeanAndSpread;

/// The delays of one fouling height.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct DelayPoint {
    /// Height of the fouled zone.
    pub height: Metres,
    /// From the surface's echo to that of the metal plate, by the peaks of the envelopes, s, one per bed.
    pub delays: Vec<f64>,
    /// Beds without an echo that can be picked.
    pub not_picked: usize,
}

/// Delay against fouling height, over many beds.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct DelayCurve {
    /// The heights.
    pub points: Vec<DelayPoint>,
    /// Thickness of the bed.
    pub thickness: Metres,
}

/// A length with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct LengthEstimate {
    /// The length.
    pub value: Metres,
    /// Standard deviation for one bed: from the scatter of the beds about the line.
    pub standard_deviation: Metres,
}

/// Simulates the beds of a scene, seeds from the scene's on, at each fouling height.
///
/// # Errors
/// When a scene or a run fails.
pub fn delay_curve(
    solver: &dyn Forward,
    spec: &SceneSpec,
    heights: &[Metres],
    seeds: u64,
    on_progress: OnProgress<'_>,
) -> Result<DelayCurve, BiasError> {
    let reference = plate_reference(solver, &scene::resolve(spec)?, on_progress)?;
    let mut points = vec![];
    for height in heights {
        let mut spec = spec.clone();
        let fines = spec.fouling.take();
        spec.fouling = (height.si() > 0.0).then(|| {
            let amount = FoulingAmount::Height(*height);
            fines.map_or_else(|| FoulingSpec::of(amount), |fines| FoulingSpec { amount, ..fines })
        });
        let mut point = DelayPoint { height: *height, delays: vec![], not_picked: 0 };
        for k in 0..seeds {
            let scene = scene::resolve(&SceneSpec { seed: spec.seed.wrapping_add(k), ..spec.clone() })?;
            match simulate_echoes(solver, &scene, &reference, on_progress) {
                Ok((_, echoes)) => {
                    point.delays.push(echoes.plate.envelope.si() - echoes.surface.envelope.si());
                }
                Err(EchoError::NotPicked { .. }) => point.not_picked += 1,
                Err(error) => return Err(error.into()),
            }
        }
        points.push(point);
    }
    Ok(DelayCurve { points, thickness: spec.tank.height })
}

impl DelayCurve {
    /// Delays of the clean bed.
    pub fn clean(&self) -> Option<MeanAndSpread> {
        MeanAndSpread::of(&self.points.iter().find(|point| point.height.si() == 0.0)?.delays)
    }

    /// Thickness of a clean bed with this delay: the nominal one times the delay over the mean of the simulated ones.
    pub fn thickness_if_clean(&self, delay: Seconds) -> Option<LengthEstimate> {
        let clean = self.clean().filter(|clean| clean.mean > 0.0)?;
        let value = self.thickness.si() * delay.si() / clean.mean;
        let standard_deviation = Metres(value * clean.standard_deviation / clean.mean);
        Some(LengthEstimate { value: Metres(value), standard_deviation })
    }

    /// Fouled height of a bed of the nominal thickness with this delay: where the line of least squares through all beds, delay
    /// over height, has it; the uncertainty is the scatter about the line over its slope. Not cut off at the bed's ends.
    ///
    /// None with fewer than three beds, one height only, or a line that does not rise.
    pub fn height_of(&self, delay: Seconds) -> Option<LengthEstimate> {
        let pairs: Vec<(f64, f64)> =
            self.points.iter().flat_map(|point| point.delays.iter().map(|d| (point.height.si(), *d))).collect();
        let n = pairs.len() as f64;
        if pairs.len() < 3 {
            return None;
        }
        let (mean_x, mean_y) = (pairs.iter().map(|p| p.0).sum::<f64>() / n, pairs.iter().map(|p| p.1).sum::<f64>() / n);
        let square: f64 = pairs.iter().map(|p| (p.0 - mean_x).powi(2)).sum();
        let slope = pairs.iter().map(|p| (p.0 - mean_x) * (p.1 - mean_y)).sum::<f64>() / square;
        if !(slope > 0.0 && slope.is_finite()) {
            return None;
        }
        let about: f64 = pairs.iter().map(|p| (p.1 - mean_y - slope * (p.0 - mean_x)).powi(2)).sum();
        let scatter = (about / (n - 2.0)).sqrt();
        let value = mean_x + (delay.si() - mean_y) / slope;
        // The bed at hand scatters as one of them, and the line itself is known from n of them.
        let own = (1.0 + 1.0 / n + (value - mean_x).powi(2) / square).sqrt();
        Some(LengthEstimate { value: Metres(value), standard_deviation: Metres(scatter / slope * own) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(scatter: f64) -> DelayCurve {
        let point = |height: f64| DelayPoint {
            height: Metres(height),
            delays: [-1.0, 0.0, 1.0].map(|e| 6e-9 + 3e-9 * height + scatter * e).to_vec(),
            not_picked: 0,
        };
        DelayCurve { points: [0.0, 0.1, 0.2, 0.3].map(point).to_vec(), thickness: Metres(0.48) }
    }

    /// The line 6 ns + 3 ns/m h: 6.45 ns is 15 cm. Beds at -s, 0, s about it scatter by `s sqrt(8/10)`; at the mean height
    /// the line adds 1/12 of the square.
    #[test]
    fn a_line_gives_back_its_height() {
        let exact = curve(0.0).height_of(Seconds(6.45e-9)).unwrap();
        assert!((exact.value.si() - 0.15).abs() < 1e-9 && exact.standard_deviation.si() < 1e-9, "{exact:?}");
        let found = curve(0.1e-9).height_of(Seconds(6.45e-9)).unwrap();
        let wanted = 0.1 * 0.8f64.sqrt() / 3.0 * (13.0f64 / 12.0).sqrt();
        assert!((found.standard_deviation.si() / wanted - 1.0).abs() < 1e-6, "{found:?}, {wanted}");
    }

    /// 10 % more delay is 10 % more clean bed.
    #[test]
    fn a_thicker_bed_is_told_by_its_delay() {
        let found = curve(0.06e-9).thickness_if_clean(Seconds(6.6e-9)).unwrap();
        assert!((found.value.si() - 0.528).abs() < 1e-9, "{found:?}");
        assert!((found.standard_deviation.si() / (0.528 * 0.01) - 1.0).abs() < 1e-6, "{found:?}");
        assert!(DelayCurve { points: vec![], ..curve(0.0) }.height_of(Seconds(6e-9)).is_none());
    }
}
