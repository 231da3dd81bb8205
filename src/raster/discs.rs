//! Which cells the stones fill, and by how much.

use crate::geometry::{Disc, disc_rectangle_area};

/// A block of square cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Block {
    /// Left lower corner, m, in the coordinates of the discs.
    pub origin: [f64; 2],
    /// Cell size, m.
    pub cell: f64,
    /// Cells along x and y.
    pub shape: [usize; 2],
}

impl Block {
    /// Cells along x and y that a disc's bounding box touches.
    fn touched(&self, disc: &Disc) -> [std::ops::Range<usize>; 2] {
        let range = |centre: f64, origin: f64, count: usize| {
            let low = ((centre - disc.radius - origin) / self.cell).floor().max(0.0) as usize;
            let high = ((centre + disc.radius - origin) / self.cell).ceil().max(0.0) as usize;
            low.min(count)..high.min(count)
        };
        [range(disc.x, self.origin[0], self.shape[0]), range(disc.y, self.origin[1], self.shape[1])]
    }
}

/// Marks the cells whose centre lies in a disc: `[i * ny + j]`.
pub(super) fn centres(block: &Block, discs: &[Disc]) -> Vec<bool> {
    let mut filled = vec![false; block.shape[0] * block.shape[1]];
    for disc in discs {
        let [xs, ys] = block.touched(disc);
        for i in xs {
            let x = block.origin[0] + (i as f64 + 0.5) * block.cell;
            for j in ys.clone() {
                let y = block.origin[1] + (j as f64 + 0.5) * block.cell;
                if disc.contains(x, y) {
                    filled[i * block.shape[1] + j] = true;
                }
            }
        }
    }
    filled
}

/// Share of each cell that lies in discs, exactly: `[i * ny + j]`, each in [0, 1].
pub(super) fn shares(block: &Block, discs: &[Disc]) -> Vec<f64> {
    let mut share = vec![0.0; block.shape[0] * block.shape[1]];
    let half_diagonal = block.cell * std::f64::consts::FRAC_1_SQRT_2;
    for disc in discs {
        let [xs, ys] = block.touched(disc);
        for i in xs {
            let x = block.origin[0] + i as f64 * block.cell - disc.x;
            for j in ys.clone() {
                let y = block.origin[1] + j as f64 * block.cell - disc.y;
                let distance = (x + 0.5 * block.cell).hypot(y + 0.5 * block.cell);
                let part = if distance + half_diagonal <= disc.radius {
                    1.0
                } else if distance - half_diagonal >= disc.radius {
                    0.0
                } else {
                    disc_rectangle_area(disc.radius, x, x + block.cell, y, y + block.cell) / (block.cell * block.cell)
                };
                share[i * block.shape[1] + j] += part;
            }
        }
    }
    for value in &mut share {
        *value = value.min(1.0);
    }
    share
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shares of all cells add up to the discs' area, whatever the cell size and the offset of the grid.
    #[test]
    fn shares_keep_the_area() {
        let discs = [Disc { x: 0.103, y: 0.098, radius: 0.031 }, Disc { x: 0.2011, y: 0.11, radius: 0.0277 }];
        let exact: f64 = discs.iter().map(Disc::area).sum();
        for cell in [0.0005, 0.002, 0.0071] {
            for shift in [0.0, 0.3, 0.77] {
                let n = (0.35 / cell) as usize;
                let block = Block { origin: [-shift * cell, -shift * cell], cell, shape: [n, n] };
                let sum = shares(&block, &discs).iter().sum::<f64>() * cell * cell;
                assert!((sum / exact - 1.0).abs() < 1e-12, "cell {cell}: {sum} against {exact}");
            }
        }
    }

    /// A cell is filled when its centre is: the count times the cell's area is near the disc's area, not equal to it.
    #[test]
    fn centres_follow_the_disc() {
        let disc = Disc { x: 0.1, y: 0.1, radius: 0.05 };
        let block = Block { origin: [0.0, 0.0], cell: 0.002, shape: [100, 100] };
        let filled = centres(&block, &[disc]);
        let area = filled.iter().filter(|f| **f).count() as f64 * 4e-6;
        assert!((area / disc.area() - 1.0).abs() < 0.01);
        assert!(filled[50 * 100 + 50] && !filled[0]);
    }
}
