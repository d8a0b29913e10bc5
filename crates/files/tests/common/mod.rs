//! What several tests start from.

/// Five lines that make an arm; what is added stands from line 6 on.
pub(crate) const ARM: &str = "\
[arm]
length = 0.2
radius = { base = 0.010, tip = 0.002 }
[material]
young = 110e3
";
