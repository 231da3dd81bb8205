//! Vertical compaction: equations 29–31 of Benedetto et al. 2018.

use crate::geometry::Disc;

/// Drops every disc straight down until it touches a disc underneath or the floor.
///
/// The domain is cut into strips of height `strip` over the full width (2 cm in the paper), taken from the bottom up; a
/// disc belongs to the strip of its centre, and inside a strip the discs go in ascending order of `y`. (The paper gives no
/// order inside a strip. In any other a disc could come to rest on one that then falls away from under it.) With this
/// order a disc only meets discs that were below it and have come to rest, so the result is the same for every strip
/// height. `x` is kept; nothing rolls, so a disc may rest on one other, which the paper calls suspended.
///
/// `y' = y_D + √((R_J + R_D)² - (x_D - x_J)²)`, the largest over the discs `D` underneath (eq. 31), or `R_J` on the floor.
///
/// When the discs do not overlap before, no disc rises and none overlap after: both by construction, up to rounding
/// (1e-12 m in a domain of metres). Time grows as N log N (the sort), the search for discs underneath is by columns and
/// stops at the first that is too low. The order of the list is kept. All lengths in metres.
pub fn compact(discs: &[Disc], width: f64, strip: f64) -> Vec<Disc> {
    let mut order: Vec<usize> = (0..discs.len()).collect();
    let strip_of = |k: usize| (discs[k].y / strip).floor();
    order.sort_by(|&a, &b| strip_of(a).total_cmp(&strip_of(b)).then(discs[a].y.total_cmp(&discs[b].y)).then(a.cmp(&b)));
    let largest = discs.iter().map(|disc| disc.radius).fold(0.0, f64::max);
    let mut columns = Columns::new(width, largest);
    let mut settled = discs.to_vec();
    for k in order {
        settled[k].y = columns.rest(&discs[k]);
        columns.insert(settled[k]);
    }
    settled
}

/// Discs at rest, sorted into vertical columns as wide as the largest disc, highest last.
struct Columns {
    side: f64,
    largest_radius: f64,
    columns: Vec<Vec<Disc>>,
}

impl Columns {
    fn new(width: f64, largest_radius: f64) -> Self {
        let side = (2.0 * largest_radius).max(width * 1e-6);
        Self { side, largest_radius, columns: vec![Vec::new(); (width / side).floor().max(0.0) as usize + 1] }
    }

    fn column(&self, x: f64) -> usize {
        ((x / self.side) as usize).min(self.columns.len() - 1)
    }

    /// Where a falling disc comes to rest.
    fn rest(&self, falling: &Disc) -> f64 {
        let mut y = falling.radius;
        let reach = falling.radius + self.largest_radius;
        for column in &self.columns[self.column(falling.x - reach)..=self.column(falling.x + reach)] {
            for under in column.iter().rev() {
                if under.y + reach <= y {
                    break;
                }
                let (sum, across) = (falling.radius + under.radius, under.x - falling.x);
                if across.abs() < sum {
                    y = y.max(under.y + ((sum - across) * (sum + across)).sqrt());
                }
            }
        }
        y
    }

    fn insert(&mut self, disc: Disc) {
        let column = self.column(disc.x);
        let column = &mut self.columns[column];
        let at = column.iter().rposition(|other| other.y <= disc.y).map_or(0, |k| k + 1);
        column.insert(at, disc);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two discs of radius 1 with centres 1.2 apart: the upper rests 1.6 above the lower (3-4-5 triangle), eq. 31.
    #[test]
    fn a_disc_rests_on_its_neighbour_where_equation_31_says() {
        let discs = [Disc { x: 2.2, y: 8.0, radius: 1.0 }, Disc { x: 1.0, y: 3.0, radius: 1.0 }];
        let settled = compact(&discs, 4.0, 0.02);
        assert_eq!(settled[1], Disc { x: 1.0, y: 1.0, radius: 1.0 });
        assert!((settled[0].y - 2.6).abs() < 1e-15, "{:?}", settled[0]);
        assert_eq!(settled[0].x, 2.2);
    }

    /// Of two discs underneath, the one that holds it higher counts.
    #[test]
    fn the_higher_of_two_supports_counts() {
        let discs = [
            Disc { x: 1.0, y: 1.0, radius: 1.0 },
            Disc { x: 3.5, y: 1.5, radius: 1.5 },
            Disc { x: 2.4, y: 9.0, radius: 0.5 },
        ];
        let settled = compact(&discs, 6.0, 0.02);
        let on_right = 1.5 + (2.0_f64.powi(2) - 1.1_f64.powi(2)).sqrt();
        assert!((settled[2].y - on_right).abs() < 1e-14, "{:?}", settled[2]);
    }
}
