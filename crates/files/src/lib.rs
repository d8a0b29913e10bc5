//! What Hydrostat reads and writes: arm files, their schema, units, results as JSON and CSV.
//!
//! An [`ArmFile`] is TOML text with overrides; [`ArmFile::arm`] is the `hydrostat::Arm` that it
//! means, and every [`FileError`] says where, what was expected and what was found. [`SolutionDocument`]
//! and [`FailureDocument`] are the JSON documents of a solve, [`write_whole`] puts any output on disk.

mod arm_file;
mod axis;
pub mod boundary;
mod commented;
mod csv_text;
mod deviations;
mod digits;
mod document;
pub mod equilibria;
mod error;
mod fitted;
pub mod followed;
mod format;
mod heads;
pub mod identification;
mod loadings;
mod marker_columns;
mod measured_columns;
mod measurements;
mod measurements_template;
mod modes;
mod motion_states;
pub mod motions;
mod others;
mod output;
pub mod paths;
mod quantity;
pub mod reach;
mod reading;
mod relative;
pub mod results;
pub mod schema;
mod setting;
mod shared_unit;
pub mod shipped;
mod slips;
pub mod spatial_motions;
mod spatial_results;
mod state;
mod syntax_hint;
mod targets;
mod time_loads;
mod varied;
mod written;

pub use arm_file::ArmFile;
pub use axis::{Axis, AxisError, AxisValue, AxisValues};
pub use boundary::{BoundaryDocument, boundary_csv};
pub use commented::commented_arm;
pub use csv_text::{Dialect, csv_row, csv_writer, is_missing};
pub use deviations::Deviations;
pub use digits::number;
pub use equilibria::{EquilibriaDocument, OverDocument, equilibria_csv, over_csv};
pub use error::{FileError, Place};
pub use fitted::{FitKey, FitKeyError, PriorKey, bare_unit, fitted};
pub use followed::{FollowedDocument, followed_csv};
pub use heads::{head_now, head_of, key_of_head};
pub use identification::{IdentificationDocument, residuals_csv, residuals_csv_with_predictions};
pub use loadings::{LoadingDocument, LoadingRow, RowSnap, loading_csv, spatial_loading_csv};
pub use measurements::{MeasurementsError, parse_measurements, read_measurements};
pub use measurements_template::measurements_template;
pub use modes::{ModesDocument, ModesOverDocument, ModesTip, mode_kind, mode_shapes_csv, modes_csv, modes_over_csv};
pub use motion_states::{SavedMotion, SavedMotionError, motion_state_beside};
pub use motions::{
    EventOut, MOTION_EVENT_HEADS, MOTION_SHAPE_HEADS, MotionDocument, MotionShape, equilibrium_numbers, motion_columns,
    motion_event_line, motion_heads, motion_line, motion_numbers, motion_row, motion_shape_lines, place_numbers,
};
pub use others::{Others, Search};
pub use output::{WriteError, is_same_file, remove_leftovers, write_whole, write_whole_with};
pub use paths::{
    Landing, PathDocument, end_message, path_csv, path_csv_with_landings, spatial_path_csv,
    spatial_path_csv_with_landings,
};
pub use quantity::{Dimension, QuantityError, STANDARD_GRAVITY, WrongValue};
pub use reach::{ReachDocument, reach_csv, spatial_reach_csv};
pub use results::{FailureDocument, Note, SolutionDocument, TOLERANCE_MISSED, UNIT_SLIP, json, stations_csv};
pub use shared_unit::{PartialUnit, shared_unit};
pub use slips::{Slip, Span, likeliest_slip, slips_beside, slips_of_spans, unit_slips};
pub use spatial_motions::{
    SPATIAL_MOTION_SHAPE_HEADS, spatial_equilibrium_numbers, spatial_motion_heads, spatial_motion_numbers,
    spatial_motion_shape_lines, spatial_place_numbers,
};
pub use spatial_results::{SpatialFailureDocument, SpatialSolutionDocument, spatial_stations_csv};
pub use targets::{TargetsError, parse_targets, read_targets};
pub use time_loads::{
    LoadRows, ShapedError, TimeLoadsError, parse_load_rows, parse_time_loads, read_load_rows, read_time_loads,
    set_shaped,
};
pub use varied::{Varied, VariedError};
pub use written::{Inputs, arm_to_toml};
