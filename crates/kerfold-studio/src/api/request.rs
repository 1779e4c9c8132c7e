//! What requests carry, read with limits and with errors of our own.

use std::sync::Arc;

use axum::body::{Body, Bytes, to_bytes};
use axum::extract::{FromRequest, FromRequestParts, Path, Query, Request};
use axum::http::header::CONTENT_LENGTH;
use axum::http::request::Parts;
use serde::de::DeserializeOwned;

use crate::tab::Tab;
use crate::{Studio, StudioError};

/// Texts and steps.
pub(crate) const TEXT_LIMIT: usize = 1 << 20;
/// Files that are dropped on the page.
pub(crate) const FILE_LIMIT: usize = 64 << 20;

/// A body, no longer than a limit.
pub(crate) async fn body(
    length: Option<usize>,
    body: Body,
    limit: usize,
) -> Result<Bytes, StudioError> {
    // What says that it is too long need not be read.
    if length.is_some_and(|length| length > limit) {
        return Err(StudioError::TooLarge { limit });
    }
    to_bytes(body, limit).await.map_err(|_| StudioError::TooLarge { limit })
}

pub(crate) fn length(request: &Request) -> Option<usize> {
    request.headers().get(CONTENT_LENGTH)?.to_str().ok()?.parse().ok()
}

/// A body of JSON.
pub(crate) struct Json<T>(pub T);

impl<S: Send + Sync, T: DeserializeOwned> FromRequest<S> for Json<T> {
    type Rejection = StudioError;

    async fn from_request(request: Request, _: &S) -> Result<Self, StudioError> {
        let length = length(&request);
        let bytes = body(length, request.into_body(), TEXT_LIMIT).await?;
        let bad = |error: serde_json::Error| StudioError::BadRequest { message: error.to_string() };
        serde_json::from_slice(&bytes).map(Self).map_err(bad)
    }
}

/// The query of an address.
pub(crate) struct Asked<T>(pub T);

impl<S: Send + Sync, T: DeserializeOwned> FromRequestParts<S> for Asked<T> {
    type Rejection = StudioError;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, StudioError> {
        let query = Query::<T>::from_request_parts(parts, state).await;
        query
            .map(|Query(asked)| Self(asked))
            .map_err(|error| StudioError::BadRequest { message: error.body_text() })
    }
}

/// The tab that an address names, and the number or name that follows it.
pub(crate) struct At {
    pub tab: Arc<Tab>,
    /// What stands after the tab; empty where nothing does.
    pub rest: String,
}

impl FromRequestParts<Arc<Studio>> for At {
    type Rejection = StudioError;

    async fn from_request_parts(
        parts: &mut Parts,
        studio: &Arc<Studio>,
    ) -> Result<Self, StudioError> {
        let bad = |message: String| StudioError::BadRequest { message };
        let Path(named) = Path::<Vec<(String, String)>>::from_request_parts(parts, studio)
            .await
            .map_err(|error| bad(error.body_text()))?;
        let mut values = named.into_iter().map(|(_, value)| value);
        let tab = studio.tab(&values.next().unwrap_or_default())?;
        Ok(Self { tab, rest: values.next().unwrap_or_default() })
    }
}

impl At {
    /// The number that follows the tab.
    pub fn number(&self) -> Result<usize, StudioError> {
        self.rest.parse().map_err(|_| StudioError::BadRequest {
            message: format!("`{}` is no number", self.rest.chars().take(40).collect::<String>()),
        })
    }
}
