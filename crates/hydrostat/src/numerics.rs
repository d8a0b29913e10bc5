//! Small numerical tools: vectors of the processor and rounds on them, small dense systems, sine and cosine of four angles.

pub(crate) mod dispatch;
pub(crate) mod elimination;
pub(crate) mod rounds;
pub(crate) mod sincos;
