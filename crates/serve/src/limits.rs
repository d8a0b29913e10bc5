//! What a request may ask for, and what the server bears at once.

use std::time::Duration;

/// Largest body and largest message, bytes.
pub(crate) const BODY: usize = 1 << 20;

/// Most stations of an answer.
pub(crate) const STATIONS: usize = 2001;

/// Most points of a path.
pub(crate) const POINTS: usize = 2000;

/// Most cables of an arm: the time of a solve grows with them.
pub(crate) const CABLES: usize = 24;

/// Most overrides of a request.
pub(crate) const SETTINGS: usize = 200;

/// How long a request may work. Paths and searches end there with what they have; for anything else there is no answer.
pub(crate) const TIME: Duration = Duration::from_secs(10);

/// How long a request may wait for its turn.
pub(crate) const PATIENCE: Duration = Duration::from_secs(10);

/// Most requests that wait for their turn.
pub(crate) const WAITING: usize = 256;

/// Most viewers at once.
pub(crate) const SESSIONS: usize = 64;

/// A viewer that says nothing for so long is let go; its page comes back by itself when it is used again.
pub(crate) const SILENCE: Duration = Duration::from_mins(30);

/// A viewer that takes nothing for so long is let go.
pub(crate) const STALLED: Duration = Duration::from_secs(10);

/// The longest piece of time that a message moves an arm on by, s.
pub(crate) const MOTION_BY: f64 = 0.25;

/// How long a message works at that: to the end of the step in time that it is in then.
pub(crate) const MOTION_WORK: Duration = Duration::from_millis(50);

/// The longest time in which a load gets elsewhere, s.
pub(crate) const MOTION_WITHIN: f64 = 3600.0;

/// Steps of a run after which another one goes on in its place.
pub(crate) const MOTION_STEPS: usize = 500_000;
