//! Sources, receivers and cut differences of a block, sorted by row.

/// Things that lie on stored rows, sorted by row.
pub struct ByRow<V> {
    things: Vec<V>,
    /// First thing of each row, and one entry more.
    of_row: Vec<usize>,
}

impl<V> ByRow<V> {
    /// Sorts things that come with their rows, of which `stored` are there.
    pub fn new(stored: usize, mut things: Vec<(usize, V)>) -> Self {
        things.sort_by_key(|(row, _)| *row);
        let of_row = (0..=stored).map(|row| things.partition_point(|(of, _)| *of < row)).collect();
        Self { things: things.into_iter().map(|(_, thing)| thing).collect(), of_row }
    }

    /// The things of a row.
    #[inline(always)]
    pub fn at(&self, row: usize) -> &[V] {
        &self.things[self.of_row[row]..self.of_row[row + 1]]
    }

    /// The things of a row, to change.
    #[inline(always)]
    pub fn at_mut(&mut self, row: usize) -> &mut [V] {
        &mut self.things[self.of_row[row]..self.of_row[row + 1]]
    }

    /// All of them.
    pub fn into_things(self) -> Vec<V> {
        self.things
    }
}

/// A source within the block.
pub struct Drive<T> {
    /// Node.
    pub j: usize,
    /// What is taken from E, per step.
    pub series: Vec<T>,
}

/// A receiver within the block, and what it has recorded.
pub struct Probe {
    /// Place in the model's list of receivers.
    pub receiver: usize,
    /// Node.
    pub j: usize,
    /// Ez, Hx, Hy, one sample per step; H still scaled.
    pub samples: [Vec<f64>; 3],
}

/// A value that no sound run reaches.
#[derive(Debug, Clone, Copy)]
pub struct Beyond {
    /// Step after which it was seen.
    pub step: usize,
    /// Node of the grid.
    pub node: [usize; 2],
    /// E there, V/m.
    pub value: f64,
}
