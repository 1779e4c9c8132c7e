//! The page: files that the build has made of `web/`.

use std::path::Path;
use std::sync::Arc;

use axum::extract::State;
use axum::http::header::{CACHE_CONTROL, CONTENT_TYPE};
use axum::http::{HeaderValue, Uri};
use axum::response::{IntoResponse, Response};

use crate::{Studio, StudioError, api, paths};

include!(concat!(env!("OUT_DIR"), "/page_files.rs"));

/// A file of the page. Everything that is no file is an error that names it.
pub(crate) async fn page(State(studio): State<Arc<Studio>>, uri: Uri) -> Response {
    let name = match uri.path().trim_start_matches('/') {
        "" => "index.html",
        name => name,
    };
    let built_in = || {
        let file = PAGE_FILES.iter().find(|(known, _)| *known == name);
        file.map(|(_, bytes)| bytes.to_vec())
    };
    let bytes = match (name, studio.page()) {
        ("api.html", _) => Some(api::description_page().into_bytes()),
        ("openapi.json", _) => Some(api::OPENAPI.as_bytes().to_vec()),
        (_, Some(folder)) => {
            let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
            paths::inside(&folder, name).ok().and_then(|path| std::fs::read(path).ok())
        }
        (_, None) => built_in(),
    };
    let Some(bytes) = bytes else {
        let path = uri.path().chars().take(200).collect();
        return StudioError::NoSuchAddress { path }.into_response();
    };
    let mut response = bytes.into_response();
    let headers = response.headers_mut();
    headers.insert(CONTENT_TYPE, HeaderValue::from_static(kind(name)));
    // The next version of the studio comes from the same address.
    headers.insert(CACHE_CONTROL, HeaderValue::from_static("no-cache"));
    response
}

fn kind(name: &str) -> &'static str {
    match Path::new(name).extension().and_then(|e| e.to_str()) {
        Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("json") => "application/json",
        Some("svg") => "image/svg+xml",
        Some("png") => "image/png",
        _ => "application/octet-stream",
    }
}
