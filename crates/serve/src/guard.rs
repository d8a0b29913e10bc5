//! What every request passes: Host and Origin against DNS rebinding and foreign pages, and headers that keep a page to itself.

use std::net::IpAddr;
use std::sync::Arc;

use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use crate::problem::Problem;

/// Names under which the server may be addressed, beside addresses and `localhost`.
pub(crate) type Names = Arc<[String]>;

/// Scripts, styles and connections of this server alone, and nothing inline; images also from what the page itself has made.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data: blob:; \
                      base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

const HEADERS: [(HeaderName, &str); 7] = [
    (header::CONTENT_SECURITY_POLICY, POLICY),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::X_FRAME_OPTIONS, "DENY"),
    (header::REFERRER_POLICY, "no-referrer"),
    (HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
    (HeaderName::from_static("permissions-policy"), "camera=(), geolocation=(), microphone=()"),
];

/// Refuses foreign requests and marks all answers.
pub(crate) async fn guard(State(names): State<Names>, request: Request, next: Next) -> Response {
    let mut response = match check(request.headers(), request.uri().host(), &names) {
        Ok(()) => next.run(request).await,
        Err(problem) => problem.into_response(),
    };
    let headers = response.headers_mut();
    for (name, value) in HEADERS {
        headers.insert(name, HeaderValue::from_static(value));
    }
    if !headers.contains_key(header::CACHE_CONTROL) {
        headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    }
    response
}

/// A page that has made its own name point here still sends that name as the host; a page of elsewhere sends its origin.
fn check(headers: &HeaderMap, of_uri: Option<&str>, names: &[String]) -> Result<(), Problem> {
    let refuse =
        |field: &str, message: String| Err(Problem::new(StatusCode::FORBIDDEN, "forbidden", Some(field), message));
    let text = |name| headers.get(name).map(|value: &HeaderValue| value.to_str().unwrap_or_default());
    let Some(host) = text(header::HOST).or(of_uri) else {
        return refuse("Host", "Host: expected the address of this server, found nothing".to_owned());
    };
    if headers.get_all(header::HOST).iter().count() > 1 || !is_ours(host, names) {
        let message = "Host: expected an address, localhost or a name given with --allow-host, found another";
        return refuse("Host", message.to_owned());
    }
    match text(header::ORIGIN) {
        None => Ok(()),
        Some(origin) if own_origin(origin, host) => Ok(()),
        Some(_) => refuse("Origin", "Origin: expected a page of this server, found another".to_owned()),
    }
}

fn own_origin(origin: &str, host: &str) -> bool {
    // Behind a proxy that ends TLS the page has https.
    ["http://", "https://"]
        .iter()
        .any(|scheme| origin.strip_prefix(scheme).is_some_and(|o| o.eq_ignore_ascii_case(host)))
}

/// An address needs no name and so cannot be rebound.
fn is_ours(host: &str, names: &[String]) -> bool {
    let name = match host.strip_prefix('[') {
        Some(rest) => return rest.split(']').next().is_some_and(|inner| inner.parse::<IpAddr>().is_ok()),
        None => host.split(':').next().unwrap_or_default(),
    };
    name.parse::<IpAddr>().is_ok()
        || name.eq_ignore_ascii_case("localhost")
        || names.iter().any(|own| own.eq_ignore_ascii_case(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn passes(host: &str, origin: Option<&str>) -> bool {
        let mut headers = HeaderMap::new();
        headers.insert(header::HOST, host.parse().unwrap());
        if let Some(origin) = origin {
            headers.insert(header::ORIGIN, origin.parse().unwrap());
        }
        check(&headers, None, &["arm.example".to_owned()]).is_ok()
    }

    #[test]
    fn addresses_and_known_names_pass_and_rebound_names_do_not() {
        for host in ["127.0.0.1:8080", "localhost:8080", "LOCALHOST", "[::1]:8080", "192.168.0.7", "arm.example:80"] {
            assert!(passes(host, None), "{host}");
        }
        for host in
            ["evil.example", "evil.example:8080", "localhost.evil.example", "127.0.0.1.evil.example", "", "[evil]"]
        {
            assert!(!passes(host, None), "{host}");
        }
        assert!(check(&HeaderMap::new(), None, &[]).is_err());
    }

    #[test]
    fn only_pages_of_this_server_may_ask() {
        assert!(passes("localhost:8080", Some("http://localhost:8080")));
        assert!(passes("arm.example", Some("https://arm.example")));
        for origin in
            ["http://evil.example", "null", "http://localhost:8081", "http://127.0.0.1:8080", "localhost:8080"]
        {
            assert!(!passes("localhost:8080", Some(origin)), "{origin}");
        }
    }
}
