//! Lines on the sheet: cut at the frame, thinned to what can be seen, and dashed.

use super::sheet::Rect;

/// Cuts a line at a rectangle; `None` in `points` is a gap. Every piece lies in the rectangle.
pub(super) fn clipped(points: impl IntoIterator<Item = Option<[f64; 2]>>, frame: &Rect) -> Vec<Vec<[f64; 2]>> {
    let mut pieces: Vec<Vec<[f64; 2]>> = Vec::new();
    let mut piece: Vec<[f64; 2]> = Vec::new();
    let mut before: Option<[f64; 2]> = None;
    let finish = |piece: &mut Vec<[f64; 2]>, pieces: &mut Vec<Vec<[f64; 2]>>| {
        if piece.len() > 1 {
            pieces.push(std::mem::take(piece));
        } else {
            piece.clear();
        }
    };
    for point in points {
        match (before, point) {
            (Some(a), Some(b)) => match clip_segment(a, b, frame) {
                Some((from, to)) => {
                    if piece.last() != Some(&from) {
                        finish(&mut piece, &mut pieces);
                        piece.push(from);
                    }
                    piece.push(to);
                }
                None => finish(&mut piece, &mut pieces),
            },
            (Some(_), None) => finish(&mut piece, &mut pieces),
            (None, _) => {}
        }
        before = point;
    }
    finish(&mut piece, &mut pieces);
    pieces
}

/// The part of a segment inside a rectangle, after Liang and Barsky (1984).
fn clip_segment(a: [f64; 2], b: [f64; 2], frame: &Rect) -> Option<([f64; 2], [f64; 2])> {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    let d = [b[0] - a[0], b[1] - a[1]];
    let limits = [(frame.x, frame.right()), (frame.y, frame.bottom())];
    for axis in 0..2 {
        let (low, high) = limits[axis];
        if d[axis] == 0.0 {
            if a[axis] < low || a[axis] > high {
                return None;
            }
            continue;
        }
        let (s, t) = ((low - a[axis]) / d[axis], (high - a[axis]) / d[axis]);
        enter = enter.max(s.min(t));
        leave = leave.min(s.max(t));
    }
    let at = |share: f64| {
        [(a[0] + share * d[0]).clamp(frame.x, frame.right()), (a[1] + share * d[1]).clamp(frame.y, frame.bottom())]
    };
    let from = if enter == 0.0 { a } else { at(enter) };
    let to = if leave == 1.0 { b } else { at(leave) };
    (enter <= leave).then_some((from, to))
}

/// Cuts a polygon at a rectangle, after Sutherland and Hodgman (1974).
pub(super) fn clip_polygon(polygon: &[[f64; 2]], frame: &Rect) -> Vec<[f64; 2]> {
    let edges = [(0, frame.x, 1.0), (0, frame.right(), -1.0), (1, frame.y, 1.0), (1, frame.bottom(), -1.0)];
    let mut kept = polygon.to_vec();
    for (axis, limit, sign) in edges {
        let inside = |p: &[f64; 2]| (p[axis] - limit) * sign >= 0.0;
        let mut next = Vec::with_capacity(kept.len() + 4);
        for (index, b) in kept.iter().enumerate() {
            let a = &kept[(index + kept.len() - 1) % kept.len()];
            if inside(a) != inside(b) {
                let t = (limit - a[axis]) / (b[axis] - a[axis]);
                let mut cut = [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
                cut[axis] = limit;
                next.push(cut);
            }
            if inside(b) {
                next.push(*b);
            }
        }
        kept = next;
    }
    kept
}

/// Width of the columns within which only the first, lowest, highest and last point are kept, points.
const COLUMN: f64 = 0.25;

/// Leaves out points that cannot be seen: of neighbours that fall into one narrow column, the first, the lowest, the
/// highest and the last stay.
pub(super) fn thinned(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let column = |p: &[f64; 2]| (p[0] / COLUMN).floor() as i64;
    let mut kept = Vec::new();
    let mut start = 0;
    while start < points.len() {
        let here = column(&points[start]);
        let end = points[start..].iter().position(|p| column(p) != here).map_or(points.len(), |n| start + n);
        let group = &points[start..end];
        if group.len() <= 4 {
            kept.extend_from_slice(group);
        } else {
            let index_of = |better: fn(f64, f64) -> bool| {
                (1..group.len()).fold(0, |best, i| if better(group[i][1], group[best][1]) { i } else { best })
            };
            let mut indices = [0, index_of(|a, b| a < b), index_of(|a, b| a > b), group.len() - 1];
            indices.sort_unstable();
            for (n, &i) in indices.iter().enumerate() {
                if n == 0 || indices[n - 1] != i {
                    kept.push(group[i]);
                }
            }
        }
        start = end;
    }
    kept
}

/// Cuts a line into dashes; `pattern` holds the lengths of dash, gap, dash, gap …, points.
pub(super) fn dashed(points: &[[f64; 2]], pattern: &[f64]) -> Vec<Vec<[f64; 2]>> {
    if pattern.is_empty() || pattern.iter().any(|&length| length < 0.1) {
        return vec![points.to_vec()];
    }
    let mut dashes = Vec::new();
    let mut dash: Vec<[f64; 2]> = points.first().copied().into_iter().collect();
    let (mut phase, mut left, mut on) = (0, pattern[0], true);
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let mut done = 0.0;
        while length - done > left {
            done += left;
            let at = [a[0] + (b[0] - a[0]) * done / length, a[1] + (b[1] - a[1]) * done / length];
            if on {
                dash.push(at);
                dashes.push(std::mem::take(&mut dash));
            } else {
                dash = vec![at];
            }
            on = !on;
            phase = (phase + 1) % pattern.len();
            left = pattern[phase];
        }
        left -= length - done;
        if on {
            dash.push(b);
        }
    }
    if on && dash.len() > 1 {
        dashes.push(dash);
    }
    dashes
}

/// Points at most `step` apart along a line: what a label would hide.
pub(super) fn sampled(points: &[[f64; 2]], step: f64) -> Vec<[f64; 2]> {
    let mut samples: Vec<[f64; 2]> = points.first().copied().into_iter().collect();
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let parts = ((b[0] - a[0]).hypot(b[1] - a[1]) / step).ceil().clamp(1.0, 1e4);
        samples.extend((1..=parts as usize).map(|k| {
            let t = k as f64 / parts;
            [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]
        }));
    }
    samples
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const FRAME: Rect = Rect::new(0.0, 0.0, 10.0, 10.0);

    #[test]
    fn a_line_is_cut_at_the_frame_and_at_gaps() {
        let line = [Some([-5.0, 5.0]), Some([5.0, 5.0]), None, Some([5.0, 5.0]), Some([5.0, 15.0]), Some([6.0, 5.0])];
        let pieces = clipped(line, &FRAME);
        let wanted = [vec![[0.0, 5.0], [5.0, 5.0]], vec![[5.0, 5.0], [5.0, 10.0]], vec![[5.5, 10.0], [6.0, 5.0]]];
        assert_eq!(pieces, wanted);
    }

    /// A dash of 3 and a gap of 2 along a length of 10: dashes from 0 to 3 and from 5 to 8.
    #[test]
    fn dashes_follow_the_pattern_round_corners() {
        let line = [[0.0, 0.0], [2.0, 0.0], [2.0, 8.0]];
        let dashes = dashed(&line, &[3.0, 2.0]);
        assert_eq!(dashes, [vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0]], vec![[2.0, 3.0], [2.0, 6.0]]]);
    }

    #[test]
    fn a_polygon_is_cut_at_the_frame() {
        let cut = clip_polygon(&[[5.0, 5.0], [15.0, 5.0], [15.0, 8.0], [5.0, 8.0]], &FRAME);
        let mut corners = cut.clone();
        corners.sort_by(|a, b| a.partial_cmp(b).unwrap());
        assert_eq!(corners, [[5.0, 5.0], [5.0, 8.0], [10.0, 5.0], [10.0, 8.0]]);
        assert!(clip_polygon(&[[20.0, 5.0], [25.0, 5.0], [25.0, 8.0]], &FRAME).is_empty());
    }

    #[test]
    fn thinning_keeps_every_peak() {
        let mut line: Vec<_> = (0..100_000).map(|i| [f64::from(i) / 1000.0, 0.0]).collect();
        line[54_321][1] = 7.0;
        line[54_322][1] = -7.0;
        let kept = thinned(&line);
        assert!(kept.len() <= 1604, "{}", kept.len());
        assert!(kept.contains(&line[54_321]) && kept.contains(&line[54_322]));
    }

    proptest! {
        /// No dash leaves the frame, and no two dashes together are longer than the line.
        #[test]
        fn cut_lines_stay_in_the_frame(points in prop::collection::vec(prop::option::weighted(0.9, [-1e6..1e6, -30.0..30.0]), 0..50)) {
            for piece in clipped(points, &FRAME) {
                prop_assert!(piece.len() > 1);
                for point in &piece {
                    prop_assert!(FRAME.contains(*point), "{point:?}");
                }
                let length = |p: &[[f64; 2]]| p.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).sum::<f64>();
                let dashes: f64 = dashed(&piece, &[2.0, 1.0]).iter().map(|d| length(d)).sum();
                prop_assert!(dashes <= length(&piece) + 1e-6);
            }
        }
    }
}
