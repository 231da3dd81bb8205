//! What a run changes from step to step, as one walk over all of its numbers.
//!
//! Saving and loading take the same walk. Each `visit` takes its type apart field by field, without `..`, so that a field
//! added later does not compile until somebody has said whether it belongs to the state.

/// Some of the numbers of a state, in the precision that they are held in.
pub enum Numbers<'a> {
    /// 32 bits each.
    Single(&'a mut [f32]),
    /// 64 bits each.
    Double(&'a mut [f64]),
}

impl Numbers<'_> {
    /// Bytes that they take.
    pub fn bytes(&self) -> u64 {
        match self {
            Self::Single(numbers) => 4 * numbers.len() as u64,
            Self::Double(numbers) => 8 * numbers.len() as u64,
        }
    }
}

/// Something that a run changes from step to step.
pub trait State {
    /// Shows every number of the state, always in the same order, whatever the machine and the number of threads.
    fn visit(&mut self, visitor: &mut dyn FnMut(Numbers<'_>));
}

impl<S: State> State for [S] {
    fn visit(&mut self, visitor: &mut dyn FnMut(Numbers<'_>)) {
        self.iter_mut().for_each(|one| one.visit(visitor));
    }
}

impl<S: State> State for Option<S> {
    fn visit(&mut self, visitor: &mut dyn FnMut(Numbers<'_>)) {
        if let Some(one) = self {
            one.visit(visitor);
        }
    }
}
