//! Small numerical tools: vectors of the processor, small dense systems, sine and cosine of four angles.

pub(crate) mod dispatch;
pub(crate) mod elimination;
pub(crate) mod sincos;
