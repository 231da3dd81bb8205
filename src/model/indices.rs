//! A long list of small numbers in as few bytes as they need.

use rayon::prelude::*;

/// Indices into a palette: one, two or four bytes each, as many as the largest needs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Indices {
    /// All below 256.
    U8(Vec<u8>),
    /// All below 65 536.
    U16(Vec<u16>),
    /// Larger ones too.
    U32(Vec<u32>),
}

impl Indices {
    /// None yet, with room for `capacity` small ones.
    pub fn with_capacity(capacity: usize) -> Self {
        Self::U8(Vec::with_capacity(capacity))
    }

    /// Adds one; widens the list where it does not fit.
    #[inline]
    pub fn push(&mut self, index: u32) {
        match self {
            Self::U8(list) if index <= u32::from(u8::MAX) => list.push(index as u8),
            Self::U16(list) if index <= u32::from(u16::MAX) => list.push(index as u16),
            Self::U32(list) => list.push(index),
            narrow => {
                narrow.widen(index);
                narrow.push(index);
            }
        }
    }

    /// Adds several.
    pub fn extend(&mut self, indices: &[u32]) {
        let largest = indices.iter().copied().max().unwrap_or(0);
        match self {
            Self::U8(list) if largest <= u32::from(u8::MAX) => list.extend(indices.iter().map(|&index| index as u8)),
            Self::U16(list) if largest <= u32::from(u16::MAX) => list.extend(indices.iter().map(|&index| index as u16)),
            Self::U32(list) => list.extend_from_slice(indices),
            narrow => {
                narrow.widen(largest);
                narrow.extend(indices);
            }
        }
    }

    /// Adds one so many times.
    pub fn push_run(&mut self, index: u32, count: usize) {
        if count == 0 {
            return;
        }
        self.push(index);
        match self {
            Self::U8(list) => list.resize(list.len() + count - 1, index as u8),
            Self::U16(list) => list.resize(list.len() + count - 1, index as u16),
            Self::U32(list) => list.resize(list.len() + count - 1, index),
        }
    }

    /// Puts lists one behind the other, each index looked up in the map of its list, on all threads.
    ///
    /// # Panics
    /// When an index has no place in its map.
    pub fn joined(lists: &[Self], maps: &[Vec<u32>]) -> Self {
        let length = lists.iter().map(Self::len).sum();
        match maps.iter().flatten().copied().max().unwrap_or(0) {
            largest if largest <= u32::from(u8::MAX) => Self::U8(join(lists, maps, length, |index| index as u8)),
            largest if largest <= u32::from(u16::MAX) => Self::U16(join(lists, maps, length, |index| index as u16)),
            _ => Self::U32(join(lists, maps, length, |index| index)),
        }
    }

    /// All of them, four bytes each.
    pub fn to_vec(&self) -> Vec<u32> {
        match self {
            Self::U8(list) => list.iter().map(|&index| u32::from(index)).collect(),
            Self::U16(list) => list.iter().map(|&index| u32::from(index)).collect(),
            Self::U32(list) => list.clone(),
        }
    }

    #[cold]
    fn widen(&mut self, to_hold: u32) {
        let all = (0..self.len()).map(|place| self.get(place));
        *self = if to_hold <= u32::from(u16::MAX) {
            Self::U16(all.map(|index| index as u16).collect())
        } else {
            Self::U32(all.collect())
        };
    }

    /// The index at a place.
    #[inline]
    pub fn get(&self, place: usize) -> u32 {
        match self {
            Self::U8(list) => u32::from(list[place]),
            Self::U16(list) => u32::from(list[place]),
            Self::U32(list) => list[place],
        }
    }

    /// A copy of the indices at a range of places.
    pub fn cut(&self, places: std::ops::Range<usize>) -> Self {
        match self {
            Self::U8(list) => Self::U8(list[places].into()),
            Self::U16(list) => Self::U16(list[places].into()),
            Self::U32(list) => Self::U32(list[places].into()),
        }
    }

    /// The indices at these places, in their order.
    pub fn picked(&self, places: &[usize]) -> Self {
        if self.is_empty() {
            return self.clone();
        }
        match self {
            Self::U8(list) => Self::U8(places.iter().map(|&place| list[place]).collect()),
            Self::U16(list) => Self::U16(places.iter().map(|&place| list[place]).collect()),
            Self::U32(list) => Self::U32(places.iter().map(|&place| list[place]).collect()),
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Self::U8(list) => list.len(),
            Self::U16(list) => list.len(),
            Self::U32(list) => list.len(),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Memory that they take, bytes.
    pub fn bytes(&self) -> usize {
        match self {
            Self::U8(list) => list.len(),
            Self::U16(list) => 2 * list.len(),
            Self::U32(list) => 4 * list.len(),
        }
    }

    /// Adds to `count[index]` for each of them.
    pub fn count_into(&self, count: &mut [usize]) {
        match self {
            Self::U8(list) => list.iter().for_each(|&index| count[usize::from(index)] += 1),
            Self::U16(list) => list.iter().for_each(|&index| count[usize::from(index)] += 1),
            Self::U32(list) => list.iter().for_each(|&index| count[index as usize] += 1),
        }
    }
}

fn join<V: Copy + Default + Send + Sync>(
    lists: &[Indices],
    maps: &[Vec<u32>],
    length: usize,
    narrow: fn(u32) -> V,
) -> Vec<V> {
    let mut joined = vec![V::default(); length];
    let mut rest = &mut joined[..];
    let mut parts = Vec::with_capacity(lists.len());
    for (list, map) in lists.iter().zip(maps) {
        let (part, behind) = std::mem::take(&mut rest).split_at_mut(list.len());
        parts.push((part, list, map));
        rest = behind;
    }
    parts.into_par_iter().for_each(|(part, list, map)| {
        let map: Vec<V> = map.iter().map(|&index| narrow(index)).collect();
        match list {
            Indices::U8(list) => part.iter_mut().zip(list).for_each(|(out, &index)| *out = map[usize::from(index)]),
            Indices::U16(list) => part.iter_mut().zip(list).for_each(|(out, &index)| *out = map[usize::from(index)]),
            Indices::U32(list) => part.iter_mut().zip(list).for_each(|(out, &index)| *out = map[index as usize]),
        }
    });
    joined
}

#[cfg(test)]
mod tests {
    use super::*;

    proptest::proptest! {
        /// What goes in comes out, however often the list is widened on the way.
        #[test]
        fn indices_keep_their_values(values in proptest::collection::vec(0u32..200_000, 0..50)) {
            let mut indices = Indices::with_capacity(4);
            values.iter().for_each(|&value| indices.push(value));
            let read: Vec<_> = (0..indices.len()).map(|place| indices.get(place)).collect();
            proptest::prop_assert_eq!(read, values);
        }
    }

    proptest::proptest! {
        /// Adding many at once, or the same one many times, is adding one after the other.
        #[test]
        fn runs_and_rows_are_many_pushes(row in proptest::collection::vec(0u32..100_000, 0..9), index in 0u32..1000, count in 0usize..5) {
            let (mut at_once, mut singly) = (Indices::with_capacity(0), Indices::with_capacity(0));
            at_once.extend(&row);
            at_once.push_run(index, count);
            row.iter().for_each(|&index| singly.push(index));
            (0..count).for_each(|_| singly.push(index));
            proptest::prop_assert_eq!(at_once.to_vec(), singly.to_vec());
        }
    }

    /// Two lists with palettes of their own, the second's entries met before: 0 and 1 are the whole's 1 and 300.
    #[test]
    fn lists_are_joined_through_their_maps() {
        let lists = [Indices::U8(vec![0, 1]), Indices::U8(vec![1, 0, 0])];
        let joined = Indices::joined(&lists, &[vec![0, 1], vec![1, 300]]);
        assert_eq!(joined, Indices::U16(vec![0, 1, 300, 1, 1]));
    }

    #[test]
    fn small_indices_take_a_byte_each() {
        let mut indices = Indices::with_capacity(0);
        (0..256).for_each(|index| indices.push(index));
        assert_eq!(indices.bytes(), 256);
        indices.push(256);
        assert_eq!(indices.bytes(), 2 * 257);
    }
}
