//! Small numerical tools: vectors of the processor and rounds on them, small dense systems, sines of four angles.

pub(crate) mod dispatch;
pub(crate) mod elimination;
pub(crate) mod rounds;
pub(crate) mod sincos;
