//! How near the limits of the section law a section comes.

/// Where a section law failed and how near each limit it was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SectionFailure {
    /// Over L.
    pub(crate) s: f64,
    /// Smallest tau.a / nu of the pulled cables.
    pub(crate) openness: f64,
    /// Stretch when it failed.
    pub(crate) nu: f64,
    /// Determinant of the section law over that of the slack one.
    pub(crate) regularity: f64,
}

/// How near the limits of the section law the stations came, each with its place (over L).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Margins {
    /// Smallest tau.a / nu of a pulled cable.
    pub(crate) openness: (f64, f64),
    /// Smallest stretch.
    pub(crate) nu: (f64, f64),
    /// Smallest determinant of the section law over that of the slack one.
    pub(crate) regularity: (f64, f64),
}

impl Margins {
    pub(crate) const FAR: Self =
        Self { openness: (1.0, 0.0), nu: (f64::INFINITY, 0.0), regularity: (f64::INFINITY, 0.0) };

    /// How near the section that failed was. It may be at an end, which is no station, or just past the limit.
    pub(crate) fn note_failure(&mut self, failure: &SectionFailure) {
        let SectionFailure { s, openness, nu, regularity } = *failure;
        self.note(s, openness.abs(), nu.abs(), regularity.abs());
    }

    #[inline(always)]
    pub(crate) fn note(&mut self, s: f64, openness: f64, nu: f64, regularity: f64) {
        for (least, value) in [(&mut self.openness, openness), (&mut self.nu, nu), (&mut self.regularity, regularity)] {
            if value < least.0 {
                *least = (value, s);
            }
        }
    }
}
