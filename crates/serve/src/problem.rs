//! Why a request gets no answer, in one form: a status, the field that is wrong, and words.

use axum::body::Body;
use axum::http::{HeaderValue, Response, StatusCode, header};
use axum::response::IntoResponse;
use hydrostat::{MotionError, PathError, ReachError, SensitivityError, SolveError, SpatialError, Verdict};
use hydrostat_files::{FileError, Place};
use serde::Serialize;

/// A request that is refused.
#[derive(Debug, Clone)]
pub(crate) struct Problem {
    pub(crate) status: StatusCode,
    pub(crate) body: Box<ProblemOut>,
}

#[derive(Debug, Clone, Serialize)]
pub(crate) struct ProblemOut {
    schema: u32,
    version: &'static str,
    pub(crate) error: Details,
}

#[derive(Debug, Clone, Serialize)]
pub(crate) struct Details {
    pub(crate) kind: &'static str,
    /// The field of the body, or the header, that is wrong.
    pub(crate) field: Option<String>,
    /// The key of the arm file, where that is what is wrong.
    pub(crate) key: Option<String>,
    /// Place in the text of the arm, from 1.
    line: Option<usize>,
    column: Option<usize>,
    pub(crate) message: String,
}

impl Problem {
    pub(crate) fn new(status: StatusCode, kind: &'static str, field: Option<&str>, message: impl Into<String>) -> Self {
        let field = field.map(str::to_owned);
        let error = Details { kind, field, key: None, line: None, column: None, message: message.into() };
        let body = ProblemOut { schema: hydrostat_files::results::SCHEMA, version: env!("CARGO_PKG_VERSION"), error };
        Self { status, body: Box::new(body) }
    }

    /// A field of the body with a wrong value.
    pub(crate) fn field(field: &str, message: impl Into<String>) -> Self {
        Self::new(StatusCode::BAD_REQUEST, "bad_request", Some(field), message)
    }

    pub(crate) fn missing(field: &str, expected: &str) -> Self {
        Self::field(field, format!("{field}: expected {expected}, found nothing"))
    }

    /// A target with another count of coordinates, or with one that is none.
    pub(crate) fn target(count: usize) -> Self {
        let (number, coordinates) = if count == 3 { ("three", "x, y and z") } else { ("two", "x and y") };
        Self::field("target", format!("target: expected {number} finite numbers, {coordinates} in m"))
    }

    /// A body that is not JSON, or no body at all.
    pub(crate) fn body(message: impl Into<String>) -> Self {
        Self::new(StatusCode::BAD_REQUEST, "bad_request", Some("body"), message)
    }

    pub(crate) fn busy(message: &'static str) -> Self {
        Self::new(StatusCode::SERVICE_UNAVAILABLE, "busy", None, message)
    }

    /// No fault of the server's, and no better when it is tried again.
    pub(crate) fn too_long() -> Self {
        let seconds = crate::limits::TIME.as_secs();
        let message =
            format!("the work took longer than the {seconds} s that a request has; loosen tol or ask for less");
        Self::new(StatusCode::UNPROCESSABLE_ENTITY, "time_limit", None, message)
    }

    pub(crate) fn defect() -> Self {
        let message = "this is a bug in the program, not a mistake in the request";
        Self::new(StatusCode::INTERNAL_SERVER_ERROR, "defect", None, message)
    }

    pub(crate) fn not_found() -> Self {
        let message = "unknown address; /api/openapi.json lists all addresses";
        Self::new(StatusCode::NOT_FOUND, "not_found", None, message)
    }

    pub(crate) fn method_not_allowed() -> Self {
        let message = "this address accepts another method; /api/openapi.json says which";
        Self::new(StatusCode::METHOD_NOT_ALLOWED, "method_not_allowed", None, message)
    }

    fn of_verdict(verdict: &Verdict, message: &str) -> Self {
        let message = format!("{message}; try: {}", verdict.advice());
        Self::new(StatusCode::UNPROCESSABLE_ENTITY, verdict.kind.name(), None, message)
    }

    fn of_key(mut self, key: Option<String>) -> Self {
        self.body.error.key = key;
        self
    }
}

impl From<FileError> for Problem {
    fn from(error: FileError) -> Self {
        let field = if matches!(error.place(), Some(Place::Setting { .. })) { "set" } else { "arm" };
        let mut problem = Self::field(field, error.to_string()).of_key(error.key().map(str::to_owned));
        if let Some(Place::Line { line, column, .. }) = error.place() {
            (problem.body.error.line, problem.body.error.column) = (Some(*line), Some(*column));
        }
        problem
    }
}

impl From<SolveError> for Problem {
    fn from(error: SolveError) -> Self {
        let message = error.to_string();
        match &error {
            SolveError::Option { option, .. } => Self::field(option, message),
            SolveError::Arm(source) => Self::field("arm", message).of_key(Some(source.key().to_owned())),
            SolveError::NoEquilibrium(failure) => Self::of_verdict(&failure.verdict, &message),
        }
    }
}

impl From<SpatialError> for Problem {
    fn from(error: SpatialError) -> Self {
        let message = error.to_string();
        match &error {
            SpatialError::Option { option, .. } => Self::field(option, message),
            SpatialError::Arm(source) => Self::field("arm", message).of_key(Some(source.key().to_owned())),
            SpatialError::NoEquilibrium(failure) => Self::of_verdict(&failure.verdict, &message),
        }
    }
}

impl<E> From<PathError<E>> for Problem
where
    E: std::error::Error + Into<Self> + 'static,
{
    fn from(error: PathError<E>) -> Self {
        let message = error.to_string();
        match error {
            PathError::Option { option, .. } => {
                Self::field(if option == "longest" { "max_step" } else { option }, message)
            }
            PathError::Value { .. } => Self::field("vary", message),
            PathError::Support => Self::field("arm", message).of_key(Some("model.support".to_owned())),
            PathError::Stroke { .. } | PathError::Friction { .. } => {
                Self::field("arm", message).of_key(Some("cable".to_owned()))
            }
            PathError::Start { source, .. } => {
                let mut problem: Self = source.into();
                problem.body.error.message = message;
                problem
            }
        }
    }
}

impl<E> From<ReachError<E>> for Problem
where
    E: std::error::Error + Into<Self> + 'static,
{
    fn from(error: ReachError<E>) -> Self {
        let message = error.to_string();
        match error {
            ReachError::Solve(source) => source.into(),
            ReachError::Target => Self::field("target", message),
            ReachError::Option { option, .. } => Self::field(option, message),
            ReachError::NoCables => Self::field("arm", message).of_key(Some("cable".to_owned())),
            ReachError::Sensitivity(SensitivityError::Station { .. }) => Self::field("station", message),
            ReachError::Sensitivity(_) => Self::field("arm", message),
        }
    }
}

impl From<MotionError> for Problem {
    fn from(error: MotionError) -> Self {
        let message = error.to_string();
        match error {
            MotionError::Arm(source) => Self::field("arm", message).of_key(Some(source.key().to_owned())),
            MotionError::Unsupported { key, .. } => Self::field("arm", message).of_key(Some(key)),
            MotionError::Course { key, .. } => Self::field("motion.loads", message).of_key(Some(key)),
            MotionError::Unfit(_) | MotionError::State { .. } => Self::field("motion.loads", message),
            MotionError::Option { .. } => Self::field("motion", message),
            MotionError::Start(source) => (*source).into(),
            MotionError::SpatialStart(source) => (*source).into(),
            MotionError::Ended(verdict) => {
                Self::new(StatusCode::UNPROCESSABLE_ENTITY, verdict.kind.name(), None, message)
            }
        }
    }
}

impl IntoResponse for Problem {
    fn into_response(self) -> Response<Body> {
        let text = hydrostat_files::json(&self.body);
        let mut response = Response::new(Body::from(text));
        *response.status_mut() = self.status;
        let headers = response.headers_mut();
        headers.insert(header::CONTENT_TYPE, HeaderValue::from_static("application/json"));
        if self.status == StatusCode::SERVICE_UNAVAILABLE {
            headers.insert(header::RETRY_AFTER, HeaderValue::from_static("1"));
        }
        response
    }
}
