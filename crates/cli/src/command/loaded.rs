//! Shapes in the plane and in space, as `hydrostat history` follows them along their loads.

use hydrostat::{Arm, Configuration, Loading, LoadingError, LoadingStep, SpatialConfiguration, SpatialSolver};
use hydrostat_figures::Posed;
use hydrostat_files::{LoadRows, LoadingDocument, LoadingRow, loading_csv, spatial_loading_csv};

use super::shape::Shape;

/// A shape that follows loads.
pub(super) trait Loaded: Shape + Posed {
    /// The arm on its way.
    type Loading;

    fn start(arm: &Arm, tol: f64) -> Result<(Self::Loading, Self), LoadingError<Self::Error>>;
    fn go_to(loading: &mut Self::Loading, arm: &Arm)
    -> Result<LoadingStep<Self, Self::Tip>, LoadingError<Self::Error>>;
    fn loading_document<'a>(
        arm: &Arm,
        loads: &'a LoadRows,
        rows: &'a [LoadingRow<Self, Self::Tip>],
        verdict: Option<String>,
    ) -> LoadingDocument<'a>;
    fn loading_csv(loads: &LoadRows, rows: &[LoadingRow<Self, Self::Tip>]) -> String;
}

macro_rules! follows {
    ($loading:ty, $start:ident, $document:ident, $csv:ident) => {
        type Loading = $loading;

        fn start(arm: &Arm, tol: f64) -> Result<($loading, Self), LoadingError<Self::Error>> {
            <$loading>::$start(arm, tol).map(|(loading, first)| (loading, first.configuration))
        }

        fn go_to(loading: &mut $loading, arm: &Arm) -> Result<LoadingStep<Self, Self::Tip>, LoadingError<Self::Error>> {
            loading.go_to(arm)
        }

        fn loading_document<'a>(
            arm: &Arm,
            loads: &'a LoadRows,
            rows: &'a [LoadingRow<Self, Self::Tip>],
            verdict: Option<String>,
        ) -> LoadingDocument<'a> {
            LoadingDocument::$document(arm, loads, rows, verdict)
        }

        fn loading_csv(loads: &LoadRows, rows: &[LoadingRow<Self, Self::Tip>]) -> String {
            $csv(loads, rows)
        }
    };
}

impl Loaded for Configuration {
    follows!(Loading, start, new, loading_csv);
}

impl Loaded for SpatialConfiguration {
    follows!(Loading<SpatialSolver>, start_in_space, in_space, spatial_loading_csv);
}
