//! The state of a motion as a file, beside its output: from it another run goes on.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use hydrostat::MotionState;
use serde::{Deserialize, Serialize};

use crate::results::json;

/// The most that is read, in bytes.
const MOST: u64 = 64 << 20;

/// The version of the file.
const FORM: u32 = 1;

/// A state, and what the run had written by then.
#[derive(Debug, Clone, PartialEq)]
pub struct SavedMotion {
    /// The state.
    pub state: MotionState,
    /// A number that tells the run's arm, loads and options from others.
    pub request: u64,
    /// Rows that were written.
    pub rows: u64,
    /// Bytes of the table, of the shapes and of the events that were written.
    pub written: [u64; 3],
}

/// Why there is no state in a file.
#[derive(Debug, thiserror::Error)]
pub enum SavedMotionError {
    /// The file could not be read, or is no text.
    #[error("{path}: cannot be read: {source}")]
    Read {
        /// The file.
        path: String,
        /// Why.
        source: io::Error,
    },
    /// It is not what `hydrostat simulate` writes beside its output.
    #[error("{path}: expected the state of a motion as `hydrostat simulate -o` writes it beside its output: {reason}")]
    Form {
        /// The file.
        path: String,
        /// What is wrong with it.
        reason: String,
    },
}

/// Where the state of the motion stands whose output is `path`.
pub fn motion_state_beside(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(ENDING);
    path.with_file_name(name)
}

/// What the names of states end in.
const ENDING: &str = ".state.json";

/// The numbers of a state, as they stand in the file.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Saved {
    motion_state: u32,
    request: String,
    rows: u64,
    written: [u64; 3],
    time: f64,
    length: f64,
    nodes: Vec<f64>,
    values: Vec<f64>,
    rates: Vec<f64>,
    second: Vec<f64>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    rotations: Vec<f64>,
    contact: Vec<Vec<f64>>,
    tensions: Vec<f64>,
    works: Vec<f64>,
    powers: Vec<f64>,
    error: f64,
    next: f64,
    jumped: Option<f64>,
    smooth: bool,
}

impl SavedMotion {
    /// As the text of a file.
    ///
    /// ```
    /// use hydrostat::{Arm, Inputs, MotionOptions, Simulation};
    /// use hydrostat_files::SavedMotion;
    ///
    /// let mut arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
    /// arm.tip.force = [0.0, 1e-3]; // N
    /// let mut simulation = Simulation::new(&arm, Inputs::default(), MotionOptions::default()).unwrap();
    /// simulation.step(0.01).unwrap();
    /// let saved = SavedMotion { state: simulation.state(), request: 1, rows: 2, written: [90, 0, 0] };
    /// let read = SavedMotion::parse(&saved.to_json(), "out.csv.state.json").unwrap();
    /// assert_eq!((read.rows, read.written, read.state.time), (2, [90, 0, 0], 0.01));
    /// ```
    pub fn to_json(&self) -> String {
        let state = self.state.clone();
        json(&Saved {
            motion_state: FORM,
            request: format!("{:016x}", self.request),
            rows: self.rows,
            written: self.written,
            time: state.time,
            length: state.length,
            nodes: state.nodes,
            values: state.values,
            rates: state.rates,
            second: state.second,
            rotations: state.rotations,
            contact: state.contact,
            tensions: state.tensions,
            works: state.works,
            powers: state.powers,
            error: state.error,
            next: state.next,
            jumped: state.jumped,
            smooth: state.smooth,
        })
    }

    /// From the text of a file `path`, which messages name.
    ///
    /// # Errors
    /// [`SavedMotionError::Form`].
    pub fn parse(text: &str, path: &str) -> Result<Self, SavedMotionError> {
        let wrong = |reason: String| SavedMotionError::Form { path: path.to_owned(), reason };
        let saved: Saved = serde_json::from_str(text).map_err(|error| wrong(error.to_string()))?;
        if saved.motion_state != FORM {
            return Err(wrong(format!("it has the form {}, this program knows {FORM}", saved.motion_state)));
        }
        let request = u64::from_str_radix(&saved.request, 16)
            .map_err(|_| wrong(format!("`request` must be hexadecimal, found \"{}\"", saved.request)))?;
        let state = MotionState {
            time: saved.time,
            length: saved.length,
            nodes: saved.nodes,
            values: saved.values,
            rates: saved.rates,
            second: saved.second,
            rotations: saved.rotations,
            contact: saved.contact,
            tensions: saved.tensions,
            works: saved.works,
            powers: saved.powers,
            error: saved.error,
            next: saved.next,
            jumped: saved.jumped,
            smooth: saved.smooth,
        };
        Ok(Self { state, request, rows: saved.rows, written: saved.written })
    }

    /// Of the motion whose output is `path`, or in the file `path` itself.
    ///
    /// # Errors
    /// [`SavedMotionError`].
    pub fn read(path: &Path) -> Result<Self, SavedMotionError> {
        let own = path.to_string_lossy().ends_with(ENDING);
        let path = if own { path.to_owned() } else { motion_state_beside(path) };
        let name = path.display().to_string();
        let mut text = String::new();
        let read = File::open(&path).and_then(|file| file.take(MOST).read_to_string(&mut text));
        read.map_err(|source| SavedMotionError::Read { path: name.clone(), source })?;
        Self::parse(&text, &name)
    }
}
