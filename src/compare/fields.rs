//! How far apart two runs of one model are, over all receivers and all six components.

use super::error::CompareError;
use super::metrics::{norm, same_axis};
use crate::trace::{AScan, Component, ReceiverTraces, Traces};

/// Computes the largest `||other - reference|| / ||reference||` over the receivers of two runs and the components that the
/// reference has recorded.
///
/// A component is measured by the norm of all three of its kind, electric or magnetic, at that receiver: one that symmetry
/// makes zero has no size of its own but round-off. A reference that is zero allows a difference of zero only (the result is
/// then infinite).
///
/// # Errors
/// When the runs do not have the same receivers, components, steps or samples.
pub fn worst_field_difference(reference: &Traces, other: &Traces) -> Result<f64, CompareError> {
    let [a, b] = [reference, other].map(|traces| traces.receivers.len());
    if a != b || a == 0 {
        return Err(CompareError::Receivers { a, b });
    }
    let mut worst: f64 = 0.0;
    for (theirs, ours) in reference.receivers.iter().zip(&other.receivers) {
        if theirs.components.is_empty() {
            return Err(CompareError::NoComponent { receiver: theirs.name.clone(), component: Component::Ez });
        }
        for magnetic in [false, true] {
            let mut largest: f64 = 0.0;
            let mut squares = 0.0;
            for a in theirs.components.iter().filter(|scan| scan.component.is_magnetic() == magnetic) {
                let b = field(ours, a.component)?;
                same_axis(a, b)?;
                let difference: Vec<f64> = a.samples.iter().zip(&b.samples).map(|(a, b)| b - a).collect();
                if difference.iter().any(|v| v.is_nan()) {
                    return Ok(f64::NAN);
                }
                largest = largest.max(norm(&difference));
                squares += norm(&a.samples).powi(2);
            }
            worst = worst.max(if largest == 0.0 { 0.0 } else { largest / squares.sqrt() });
        }
    }
    Ok(worst)
}

fn field(receiver: &ReceiverTraces, component: Component) -> Result<&AScan, CompareError> {
    let missing = || CompareError::NoComponent { receiver: receiver.name.clone(), component };
    receiver.component(component).ok_or_else(missing)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::{Metres, Seconds};

    fn traces(components: [f64; 6]) -> Traces {
        let position = [Metres(0.0); 3];
        let scans = Component::FIELDS.iter().zip(components).map(|(&component, value)| AScan {
            samples: vec![value, 0.0],
            time_step: Seconds(1e-12),
            first_sample: Seconds(0.0),
            component,
            position: Some(position),
            name: "rx".into(),
        });
        let receiver = ReceiverTraces { name: "rx".into(), position, components: scans.collect() };
        Traces {
            title: String::new(),
            solver: String::new(),
            time_step: Seconds(1e-12),
            iterations: 2,
            cells: [1; 3],
            spacing: [Metres(1.0); 3],
            double_precision: true,
            receivers: vec![receiver],
        }
    }

    /// By hand: E is 3, 4, 0 (norm 5) and off by 1 in z: 0.2; H is zero in both and counts for nothing.
    #[test]
    fn a_component_is_measured_by_the_norm_of_its_kind() {
        let reference = traces([3.0, 4.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(worst_field_difference(&reference, &reference), Ok(0.0));
        assert_eq!(worst_field_difference(&reference, &traces([3.0, 4.0, 1.0, 0.0, 0.0, 0.0])), Ok(0.2));
        assert_eq!(worst_field_difference(&reference, &traces([3.0, 4.0, 0.0, 1e-9, 0.0, 0.0])), Ok(f64::INFINITY));
        assert!(worst_field_difference(&reference, &traces([f64::NAN, 4.0, 0.0, 0.0, 0.0, 0.0])).unwrap().is_nan());
    }

    #[test]
    fn other_receivers_or_components_are_refused() {
        let (reference, mut other) = (traces([1.0; 6]), traces([1.0; 6]));
        other.receivers[0].components.pop();
        let message = worst_field_difference(&reference, &other).unwrap_err().to_string();
        assert_eq!(message, "receiver `rx` has no Hz");
        other.receivers.clear();
        let message = worst_field_difference(&reference, &other).unwrap_err().to_string();
        assert_eq!(message, "1 receivers cannot be compared with 0");
    }
}
