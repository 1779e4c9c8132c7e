//! The addresses of the studio, each with what it does; `openapi.json` tells them to other
//! programs, and a test compares the two.

mod files;
mod model;
mod outputs;
mod recipe;
mod request;
mod result;

use std::fmt::Write as _;
use std::sync::Arc;

use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::middleware::from_fn_with_state;

use crate::guard::guard;
use crate::{Studio, page};

/// The description for other programs.
pub(crate) const OPENAPI: &str = include_str!("../../openapi.json");

macro_rules! routes {
    ($($method:ident $path:literal => $handler:path;)*) => {
        /// Every address under `/api` with its method.
        #[cfg(test)]
        const ROUTES: &[(&str, &str)] = &[$((stringify!($method), $path)),*];

        fn routes() -> Router<Arc<Studio>> {
            Router::new()$(.route($path, axum::routing::$method($handler)))*
        }
    };
}

routes! {
    get "/api/schema" => recipe::schema;
    get "/api/files" => files::list;
    put "/api/files/{*name}" => files::upload;
    post "/api/tabs" => recipe::open_tab;
    get "/api/tabs/{tab}" => recipe::state;
    get "/api/tabs/{tab}/events" => recipe::events;
    get "/api/tabs/{tab}/recipe" => recipe::text;
    put "/api/tabs/{tab}/recipe" => recipe::open;
    put "/api/tabs/{tab}/name" => recipe::rename;
    post "/api/tabs/{tab}/steps" => recipe::apply;
    patch "/api/tabs/{tab}/steps/{step}" => recipe::set;
    delete "/api/tabs/{tab}/steps/{step}" => recipe::remove;
    post "/api/tabs/{tab}/undo" => recipe::undo;
    post "/api/tabs/{tab}/redo" => recipe::redo;
    delete "/api/tabs/{tab}/work" => recipe::stop;
    get "/api/tabs/{tab}/model" => model::model;
    post "/api/tabs/{tab}/preview" => model::preview;
    post "/api/tabs/{tab}/limit" => model::limit;
    post "/api/tabs/{tab}/mark" => model::mark;
    get "/api/tabs/{tab}/seams" => model::seams;
    get "/api/tabs/{tab}/result" => result::result;
    get "/api/tabs/{tab}/sheets/{sheet}" => result::sheet;
    get "/api/tabs/{tab}/bloom" => result::bloom;
    post "/api/tabs/{tab}/save" => outputs::save;
    post "/api/tabs/{tab}/export" => outputs::export;
    get "/api/tabs/{tab}/export.zip" => outputs::archive;
}

/// All of the studio.
pub(crate) fn router(studio: Arc<Studio>) -> Router {
    routes()
        .fallback(page::page)
        // Bodies are limited where they are read, so that the refusal has a code.
        .layer(DefaultBodyLimit::disable())
        .layer(from_fn_with_state(studio.clone(), guard))
        .with_state(studio)
}

/// `openapi.json` as a page for people.
pub(crate) fn description_page() -> String {
    let described: serde_json::Value = serde_json::from_str(OPENAPI).unwrap_or_default();
    let text = |value: &serde_json::Value| {
        let text = value.as_str().unwrap_or_default();
        text.replace('&', "&amp;").replace('<', "&lt;")
    };
    let mut page = format!(
        "<!doctype html><html lang=en><meta charset=utf-8><title>{0}</title><style>body{{max-width:\
        46em;margin:2em auto;padding:0 1em;font:16px/1.5 system-ui;color-scheme:light dark}}code{{\
        font-weight:600}}dt{{margin-top:1em}}</style><h1>{0}</h1><p>{1}</p><dl>",
        text(&described["info"]["title"]),
        text(&described["info"]["description"]),
    );
    for (path, methods) in described["paths"].as_object().into_iter().flatten() {
        for (method, told) in methods.as_object().into_iter().flatten() {
            let _ = write!(
                page,
                "<dt><code>{} {path}</code></dt><dd>{}<br>{}</dd>",
                method.to_uppercase(),
                text(&told["summary"]),
                text(&told["description"]),
            );
        }
    }
    page + "</dl></html>\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_description_tells_every_address_and_no_other() {
        let described: serde_json::Value = serde_json::from_str(OPENAPI).expect("JSON");
        let mut told: Vec<(String, String)> = Vec::new();
        for (path, methods) in described["paths"].as_object().expect("paths") {
            for (method, what) in methods.as_object().expect("methods") {
                assert!(what["summary"].as_str().is_some_and(|s| s.len() > 5), "{method} {path}");
                assert!(what["responses"].is_object(), "{method} {path}");
                told.push((method.clone(), path.clone()));
            }
        }
        let mut known: Vec<(String, String)> = ROUTES
            .iter()
            .map(|(method, path)| ((*method).to_owned(), path.replace("{*", "{")))
            .collect();
        told.sort();
        known.sort();
        assert_eq!(told, known);
    }
}
