//! Everything that a request can be refused for, with its code and its status.

use axum::Json;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use kerfold::code::{Coded, codes};
use kerfold::io::IoError;
use kerfold::make::MakeError;
use kerfold::op::OpError;
use kerfold::recipe::{RecipeError, SessionError, StepError};
use kerfold::seam::SeamError;
use kerfold::select::{ParseError, SelectError};
use serde_json::json;

/// Why a request, or the start, was refused.
#[derive(Debug, thiserror::Error)]
pub enum StudioError {
    /// Asked for under the name of another machine, as a page does that lies about its address.
    #[error("this is not the studio of `{host}`; open the address that it printed when it started")]
    Host {
        /// The name.
        host: String,
    },
    /// Asked for by a page of another origin.
    #[error("a page of {origin} may not use the studio; open the address that it printed")]
    Origin {
        /// Where the page came from.
        origin: String,
    },
    /// Without the token of the address, or with another one.
    #[error("the token is missing or wrong; open the address that the studio printed")]
    Token,
    /// A file outside the folder of the studio.
    #[error(
        "`{path}` lies outside the folder in which the studio was started; put the file into that \
        folder and name it from there"
    )]
    Outside {
        /// The file.
        path: String,
    },
    /// A request larger than any should be.
    #[error("the request is larger than {limit} bytes; send less at once")]
    TooLarge {
        /// The limit.
        limit: usize,
    },
    /// No such tab.
    #[error("there is no tab `{tab}` any more; reload the page")]
    NoSuchTab {
        /// Its name.
        tab: String,
    },
    /// A newer value came while this one was worked out.
    #[error("a newer value came in between; its answer counts")]
    Superseded,
    /// No such address.
    #[error("`{path}` is nothing that the studio serves; see openapi.json")]
    NoSuchAddress {
        /// The address.
        path: String,
    },
    /// A request that cannot be read.
    #[error("the request cannot be read: {message}")]
    BadRequest {
        /// What is wrong.
        message: String,
    },
    /// A file of this name is there, and it is another one.
    #[error("there is another file `{file}` already; choose another name, or say that it may go")]
    Exists {
        /// The file.
        file: String,
    },
    /// Pieces or sheets are asked for, and the recipe makes none.
    #[error("the recipe makes no {what} yet; put a step to it that does, such as unfold")]
    NotMade {
        /// What is missing.
        what: &'static str,
    },
    /// The port is taken, or the system does not let us listen.
    #[error(
        "port {port} of this machine cannot be listened to: {error}; choose another one with --port, or 0"
    )]
    Port {
        /// The port.
        port: u16,
        /// What the system says.
        error: std::io::Error,
    },
    /// A file cannot be read, or is of no known kind.
    #[error("{file}: {message}")]
    File {
        /// The file.
        file: String,
        /// What is wrong with it.
        message: String,
    },
    /// The session refuses.
    #[error(transparent)]
    Session(#[from] SessionError),
    /// A recipe cannot be read.
    #[error(transparent)]
    Recipe(#[from] RecipeError),
    /// Something cannot be made.
    #[error(transparent)]
    Make(#[from] MakeError),
    /// A selection cannot be read.
    #[error(transparent)]
    Parse(#[from] ParseError),
    /// A selection selects nothing.
    #[error(transparent)]
    Select(#[from] SelectError),
    /// No seams can be listed.
    #[error(transparent)]
    Seam(#[from] SeamError),
    /// A file cannot be written.
    #[error(transparent)]
    Io(#[from] IoError),
}

codes!(error StudioError {
    Host = 901,
    Origin = 902,
    Token = 903,
    Outside = 904,
    TooLarge = 905,
    NoSuchTab = 906,
    Superseded = 907,
    NoSuchAddress = 908,
    BadRequest = 909,
    Exists = 910,
    NotMade = 911,
    Port = 912,
    File = 913,
} through {
    Session.0,
    Recipe.0,
    Make.0,
    Parse.0,
    Select.0,
    Seam.0,
    Io.0,
});

impl From<StepError> for StudioError {
    fn from(error: StepError) -> Self {
        Self::Session(error.into())
    }
}

impl StudioError {
    fn status(&self) -> StatusCode {
        match self {
            Self::Host { .. } => StatusCode::MISDIRECTED_REQUEST,
            Self::Origin { .. } | Self::Outside { .. } => StatusCode::FORBIDDEN,
            Self::Token => StatusCode::UNAUTHORIZED,
            Self::TooLarge { .. } => StatusCode::PAYLOAD_TOO_LARGE,
            Self::NoSuchTab { .. } | Self::NoSuchAddress { .. } | Self::NotMade { .. } => {
                StatusCode::NOT_FOUND
            }
            Self::Superseded | Self::Exists { .. } => StatusCode::CONFLICT,
            Self::BadRequest { .. } => StatusCode::BAD_REQUEST,
            Self::Port { .. } => StatusCode::INTERNAL_SERVER_ERROR,
            _ => StatusCode::UNPROCESSABLE_ENTITY,
        }
    }

    /// Whether work was stopped because its answer is not wanted any more.
    pub(crate) fn is_stopped(&self) -> bool {
        matches!(self, Self::Session(SessionError::Run(StepError { cause, .. }))
            if matches!(**cause, MakeError::Op(OpError::Cancelled)))
    }
}

impl IntoResponse for StudioError {
    fn into_response(self) -> Response {
        let (step, key) = match &self {
            Self::Session(SessionError::Step { step, key, .. }) => (Some(*step), key.clone()),
            Self::Session(SessionError::Run(error)) => (Some(error.step), None),
            _ => (None, None),
        };
        let line = match &self {
            Self::Recipe(error) => error.at().map(|at| [at.line, at.column]),
            _ => None,
        };
        let told = json!({
            "code": self.code().to_string(), "message": self.to_string(),
            "step": step, "key": key, "at": line,
        });
        (self.status(), Json(told)).into_response()
    }
}
