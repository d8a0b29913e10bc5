//! How much is run, and who is told.

/// How much is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Scope {
    /// Everything: some minutes.
    #[default]
    Whole,
    /// The same checks on fewer cases: some seconds.
    Quick,
}

/// What is happening while [`run`](crate::run) works: told from several threads.
pub trait Listener: Sync {
    /// A part begins; `part` counts from 1.
    fn begins(&self, part: usize, of: usize, title: &str);

    /// `done` of `of` pieces of the present part are done.
    fn advances(&self, done: usize, of: usize);
}
