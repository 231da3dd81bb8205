//! A long list of small numbers in as few bytes as they need.

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

    #[test]
    fn small_indices_take_a_byte_each() {
        let mut indices = Indices::with_capacity(0);
        (0..256).for_each(|index| indices.push(index));
        assert_eq!(indices.bytes(), 256);
        indices.push(256);
        assert_eq!(indices.bytes(), 2 * 257);
    }
}
