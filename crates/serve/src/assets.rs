//! The page, inside the program. What stands in `page/` is served as it stands; the palette is made of that of the figures.

use axum::http::HeaderName;
use axum::http::header::{CACHE_CONTROL, CONTENT_TYPE};
use axum::response::{IntoResponse, Response};

use crate::options::palette_css;

struct Asset {
    path: &'static str,
    content_type: &'static str,
    text: &'static str,
}

const HTML: &str = "text/html; charset=utf-8";
const CSS: &str = "text/css; charset=utf-8";
const JS: &str = "text/javascript; charset=utf-8";
const SVG: &str = "image/svg+xml";

macro_rules! asset {
    ($path:literal, $content_type:expr, $file:literal) => {
        Asset { path: $path, content_type: $content_type, text: include_str!(concat!("../page/", $file)) }
    };
}

const ASSETS: &[Asset] = &[
    asset!("/", HTML, "index.html"),
    asset!("/icon.svg", SVG, "icon.svg"),
    asset!("/style.css", CSS, "style.css"),
    asset!("/theme.js", JS, "theme.js"),
    asset!("/main.js", JS, "main.js"),
    asset!("/arm_view.js", JS, "arm_view.js"),
    asset!("/camera.js", JS, "camera.js"),
    asset!("/chart.js", JS, "chart.js"),
    asset!("/charts.js", JS, "charts.js"),
    asset!("/connection.js", JS, "connection.js"),
    asset!("/controls.js", JS, "controls.js"),
    asset!("/geometry.js", JS, "geometry.js"),
    asset!("/help.html", HTML, "help.html"),
    asset!("/help.js", JS, "help.js"),
    asset!("/help_page.js", JS, "help_page.js"),
    asset!("/motion.js", JS, "motion.js"),
    asset!("/numbers.js", JS, "numbers.js"),
    asset!("/page.js", JS, "page.js"),
    asset!("/paint.js", JS, "paint.js"),
    asset!("/share.js", JS, "share.js"),
    asset!("/solid.js", JS, "solid.js"),
    asset!("/state.js", JS, "state.js"),
    asset!("/studies.js", JS, "studies.js"),
    asset!("/words.js", JS, "words.js"),
];

/// What is served at `path`.
pub(crate) fn get(path: &str) -> Option<Response> {
    if path == "/palette.css" {
        return Some(([(CONTENT_TYPE, CSS), (CACHE_CONTROL, "no-cache")], palette_css()).into_response());
    }
    let asset = ASSETS.iter().find(|asset| asset.path == path)?;
    // Another version of the program has another page at the same address: ask again each time.
    let headers: [(HeaderName, &str); 2] = [(CONTENT_TYPE, asset.content_type), (CACHE_CONTROL, "no-cache")];
    Some((headers, asset.text).into_response())
}
