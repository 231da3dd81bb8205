//! Finding room: where a label hides the least and overlaps no other.

use super::sheet::Rect;

/// What already fills the frame.
#[derive(Debug, Clone, Default)]
pub(super) struct Room {
    /// Rectangles that no label may touch.
    pub(super) taken: Vec<Rect>,
    /// Points of curves and symbols, which a label should not hide.
    pub(super) ink: Vec<[f64; 2]>,
}

impl Room {
    /// How many points of ink a rectangle hides.
    pub(super) fn hidden(&self, place: &Rect) -> usize {
        self.ink.iter().filter(|&&point| place.contains(point)).count()
    }

    /// The first of the candidates that hides the least, among those in the frame that overlap nothing taken; it is
    /// taken from then on.
    pub(super) fn claim(&mut self, frame: &Rect, candidates: impl IntoIterator<Item = Rect>) -> Option<Rect> {
        let mut best: Option<(usize, Rect)> = None;
        for place in candidates {
            if !frame.encloses(&place) || self.taken.iter().any(|other| other.overlaps(&place)) {
                continue;
            }
            let hidden = self.hidden(&place);
            if best.is_none_or(|(least, _)| hidden < least) {
                best = Some((hidden, place));
            }
            if hidden == 0 {
                break;
            }
        }
        let place = best?.1;
        self.taken.push(place);
        Some(place)
    }
}

/// Places for a label of the given size around a point, the nearest first, on rings of growing distance.
pub(super) fn around([x, y]: [f64; 2], width: f64, height: f64) -> Vec<Rect> {
    let mut places = Vec::new();
    for ring in 0..4 {
        let gap = 7.0 + 16.0 * f64::from(ring);
        let (left, right) = (x - gap - width, x + gap);
        let (above, below) = (y - gap - height, y + gap);
        let (centre, middle) = (x - width / 2.0, y - height / 2.0);
        let corners = [(right, above), (left, above), (right, below), (left, below)];
        let sides = [(centre, above), (right, middle), (left, middle), (centre, below)];
        places.extend(corners.into_iter().chain(sides).map(|(x, y)| Rect::new(x, y, width, height)));
    }
    places
}

/// Places for a label beside an upright line through the frame, the topmost first, right before left.
pub(super) fn beside_upright(x: f64, frame: &Rect, width: f64, height: f64) -> Vec<Rect> {
    let tiers = ((frame.height - 8.0) / (height + 2.0)).floor().max(0.0) as usize;
    (0..tiers)
        .flat_map(|tier| {
            let y = frame.y + 5.0 + tier as f64 * (height + 2.0);
            [x + 5.0, x - 5.0 - width].map(|x| Rect::new(x, y, width, height))
        })
        .collect()
}

/// Places for a label above or below a level line through the frame, the rightmost first.
pub(super) fn beside_level(y: f64, frame: &Rect, width: f64, height: f64) -> Vec<Rect> {
    let steps = (frame.width / (width / 2.0).max(8.0)).floor().clamp(0.0, 200.0) as usize;
    (0..steps)
        .flat_map(|step| {
            let x = frame.right() - 6.0 - width - step as f64 * (width / 2.0).max(8.0);
            [y - 4.0 - height, y + 4.0].map(|y| Rect::new(x, y, width, height))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Whatever is asked for, what is given lies in the frame and overlaps nothing given before.
        #[test]
        fn claimed_places_never_overlap(points in prop::collection::vec(([0.0..300.0, 0.0..200.0], 5.0..120.0), 1..60)) {
            let frame = Rect::new(0.0, 0.0, 300.0, 200.0);
            let mut room = Room { ink: points.iter().map(|p| p.0).collect(), ..Room::default() };
            let mut given = Vec::new();
            for (index, (point, width)) in points.into_iter().enumerate() {
                let places = match index % 3 {
                    0 => around(point, width, 14.0),
                    1 => beside_upright(point[0], &frame, width, 14.0),
                    _ => beside_level(point[1], &frame, width, 14.0),
                };
                given.extend(room.claim(&frame, places));
            }
            prop_assert!(!given.is_empty());
            for (i, a) in given.iter().enumerate() {
                prop_assert!(frame.encloses(a));
                for b in &given[i + 1..] {
                    prop_assert!(!a.overlaps(b));
                }
            }
        }
    }
}
