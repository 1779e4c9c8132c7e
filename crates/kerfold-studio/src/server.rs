//! Listens to this machine, and to nothing else.

use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;

use tokio::net::TcpListener;

use crate::{Studio, StudioError, StudioOptions, api};

/// A studio that listens.
pub struct Serving {
    listener: TcpListener,
    studio: Arc<Studio>,
}

/// Takes a port; 0 is a free one.
///
/// # Errors
/// [`StudioError::Port`] when it is taken, [`StudioError::File`] for a folder that is none.
pub async fn serve(options: StudioOptions, port: u16) -> Result<Serving, StudioError> {
    let refused = |error| StudioError::Port { port, error };
    let address = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
    let listener = TcpListener::bind(address).await.map_err(refused)?;
    let port = listener.local_addr().map_err(refused)?.port();
    Ok(Serving { listener, studio: Arc::new(Studio::new(options, port)?) })
}

impl Serving {
    /// The address for a browser.
    pub fn address(&self) -> String {
        self.studio.address()
    }

    /// The studio itself.
    pub fn studio(&self) -> &Arc<Studio> {
        &self.studio
    }

    /// Answers until the system or the user ends it.
    ///
    /// # Errors
    /// What the system says.
    pub async fn run(self) -> std::io::Result<()> {
        axum::serve(self.listener, api::router(self.studio)).await
    }
}
