//! Who may ask: this machine, by the address that was printed. A page of another origin cannot send
//! the token, a host name that was rebound to this machine is not ours, and both are refused before
//! anything is read.

use std::sync::Arc;

use axum::extract::{Request, State};
use axum::http::header::{HOST, ORIGIN};
use axum::http::{HeaderMap, HeaderValue};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use crate::{Studio, StudioError};

/// The header that carries the token.
pub(crate) const TOKEN: &str = "x-kerfold-token";

pub(crate) async fn guard(
    State(studio): State<Arc<Studio>>,
    request: Request,
    next: Next,
) -> Response {
    let mut response = match refusal(&studio, &request) {
        Some(error) => error.into_response(),
        None => next.run(request).await,
    };
    let headers = [
        ("x-content-type-options", "nosniff"),
        ("x-frame-options", "DENY"),
        ("referrer-policy", "no-referrer"),
        ("cross-origin-resource-policy", "same-origin"),
        ("cross-origin-opener-policy", "same-origin"),
        (
            "content-security-policy",
            "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; \
            frame-ancestors 'none'; base-uri 'none'; form-action 'none'",
        ),
    ];
    for (name, value) in headers {
        response.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    response
}

fn refusal(studio: &Studio, request: &Request) -> Option<StudioError> {
    let headers = request.headers();
    let ours = studio.hosts();
    let host = headers.get(HOST).and_then(|host| host.to_str().ok()).unwrap_or_default();
    if !ours.iter().any(|name| name == host) {
        return Some(StudioError::Host { host: host.chars().take(100).collect() });
    }
    if let Some(origin) = headers.get(ORIGIN) {
        let origin = origin.to_str().unwrap_or_default();
        if !ours.iter().any(|name| origin.strip_prefix("http://") == Some(name)) {
            return Some(StudioError::Origin { origin: origin.chars().take(100).collect() });
        }
    }
    // The page itself holds nothing; it brings the token along from the address.
    let is_api = request.uri().path().starts_with("/api/");
    (is_api && !is_known(studio, headers, request.uri().query())).then_some(StudioError::Token)
}

/// Whether the right token is there: in the header, or in the query for what a browser fetches by
/// itself (the event stream, downloads).
fn is_known(studio: &Studio, headers: &HeaderMap, query: Option<&str>) -> bool {
    let of_header = headers.get(TOKEN).and_then(|token| token.to_str().ok());
    let of_query =
        || query.unwrap_or_default().split('&').find_map(|pair| pair.strip_prefix("token="));
    of_header.or_else(of_query).is_some_and(|token| is_same(token, studio.token()))
}

/// Takes as long wherever the two differ.
fn is_same(a: &str, b: &str) -> bool {
    a.len() == b.len() && a.bytes().zip(b.bytes()).fold(0, |differ, (x, y)| differ | (x ^ y)) == 0
}
