//! Which address answers what.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use axum::Router;
use axum::body::Bytes;
use axum::extract::rejection::BytesRejection;
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::ws::rejection::WebSocketUpgradeRejection;
use axum::extract::{DefaultBodyLimit, State};
use axum::http::{HeaderMap, StatusCode, Uri, header};
use axum::middleware::from_fn_with_state;
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};

use crate::answers::{self, Answer};
use crate::arm_source::Given;
use crate::guard::{Names, guard};
use crate::openapi;
use crate::options::OptionsDocument;
use crate::problem::Problem;
use crate::requests::read;
use crate::work::{Deadline, Weight, Work};
use crate::{assets, limits, session};

/// What all requests share.
#[derive(Debug, Clone)]
pub(crate) struct Shared {
    pub(crate) given: Option<Arc<Given>>,
    pub(crate) work: Arc<Work>,
    pub(crate) sessions: Arc<AtomicUsize>,
}

pub(crate) fn router(shared: Shared, names: Names) -> Router {
    Router::new()
        .route("/api/openapi.json", get(async || Answer::json(&openapi::document())))
        .route("/api/arm.schema.json", get(async || Answer::json(&hydrostat_files::schema::arm_schema())))
        .route("/api/session.schema.json", get(async || Answer::json(&openapi::session_schema())))
        .route("/api/options", get(async || Answer::json(&OptionsDocument::new())))
        .route("/api/arms", get(arms))
        .route("/api/check", post(check))
        .route("/api/solve", post(solve))
        .route("/api/path", post(path))
        .route("/api/equilibria", post(equilibria))
        .route("/api/reach", post(reach))
        .route("/api/session", get(open_session))
        .fallback(get(asset))
        .method_not_allowed_fallback(async || Problem::method_not_allowed())
        .layer(DefaultBodyLimit::max(limits::BODY))
        .layer(from_fn_with_state(names, guard))
        .with_state(shared)
}

impl IntoResponse for Answer {
    fn into_response(self) -> Response {
        ([(header::CONTENT_TYPE, self.content_type)], self.bytes).into_response()
    }
}

async fn asset(uri: Uri) -> Response {
    assets::get(uri.path()).unwrap_or_else(|| Problem::not_found().into_response())
}

async fn arms(State(shared): State<Shared>) -> Answer {
    answers::arms(shared.given.as_deref())
}

type Body = Result<Bytes, BytesRejection>;

/// Does the work of a body when its turn comes.
async fn worked<F>(shared: &Shared, headers: &HeaderMap, body: Body, weight: Weight, job: F) -> Result<Answer, Problem>
where
    F: FnOnce(&[u8], Deadline) -> Result<Answer, Problem> + Send + 'static,
{
    let text = json_body(headers, body)?;
    shared.work.run(weight, move |deadline| job(&text, deadline)).await?
}

/// A body that says that it is JSON: what a form of a foreign page cannot say without asking first.
fn json_body(headers: &HeaderMap, body: Body) -> Result<Bytes, Problem> {
    let kind = headers.get(header::CONTENT_TYPE).and_then(|value| value.to_str().ok()).unwrap_or_default();
    let kind = kind.split(';').next().unwrap_or_default().trim();
    if !kind.eq_ignore_ascii_case("application/json") {
        let message = "Content-Type: expected application/json";
        return Err(Problem::new(StatusCode::UNSUPPORTED_MEDIA_TYPE, "media_type", Some("Content-Type"), message));
    }
    body.map_err(|rejection| {
        if rejection.status() == StatusCode::PAYLOAD_TOO_LARGE {
            let message = format!("body: expected at most {} bytes, found more", limits::BODY);
            return Problem::new(StatusCode::PAYLOAD_TOO_LARGE, "too_large", Some("body"), message);
        }
        Problem::body("the body could not be read")
    })
}

async fn check(State(shared): State<Shared>, headers: HeaderMap, body: Body) -> Result<Answer, Problem> {
    worked(&shared, &headers, body, Weight::Light, |text, _| answers::check(&read(text)?)).await
}

async fn solve(State(shared): State<Shared>, headers: HeaderMap, body: Body) -> Result<Answer, Problem> {
    worked(&shared, &headers, body, Weight::Light, |text, deadline| answers::solve(&read(text)?, deadline)).await
}

async fn path(State(shared): State<Shared>, headers: HeaderMap, body: Body) -> Result<Answer, Problem> {
    worked(&shared, &headers, body, Weight::Heavy, |text, deadline| answers::path(&read(text)?, deadline)).await
}

async fn equilibria(State(shared): State<Shared>, headers: HeaderMap, body: Body) -> Result<Answer, Problem> {
    worked(&shared, &headers, body, Weight::Heavy, |text, deadline| answers::equilibria(&read(text)?, deadline)).await
}

async fn reach(State(shared): State<Shared>, headers: HeaderMap, body: Body) -> Result<Answer, Problem> {
    worked(&shared, &headers, body, Weight::Heavy, |text, deadline| answers::reach(&read(text)?, deadline)).await
}

/// One of the viewers; counted while it lives.
struct Seat(Arc<AtomicUsize>);

impl Drop for Seat {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

async fn open_session(
    State(shared): State<Shared>,
    upgrade: Result<WebSocketUpgrade, WebSocketUpgradeRejection>,
) -> Result<Response, Problem> {
    let upgrade = upgrade.map_err(|_| {
        let message = "Upgrade: expected a WebSocket handshake";
        Problem::new(StatusCode::UPGRADE_REQUIRED, "upgrade_required", Some("Upgrade"), message)
    })?;
    let taken = shared.sessions.fetch_add(1, Ordering::Relaxed);
    let seat = Seat(Arc::clone(&shared.sessions));
    if taken >= limits::SESSIONS {
        return Err(Problem::busy("the largest number of open viewers is reached; close one first"));
    }
    let upgrade = upgrade.max_message_size(limits::BODY).max_frame_size(limits::BODY);
    Ok(upgrade.on_upgrade(async move |socket| {
        let _seat = seat;
        session::converse(socket, shared.work).await;
    }))
}
