//! A studio on a free port, and clients for it.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::time::Duration;

use http_body_util::{BodyExt, Full};
use hyper::body::Bytes;
use hyper::client::conn::http1;
use hyper_util::rt::TokioIo;
use kerfold_studio::{StudioOptions, serve};
use serde_json::Value;

/// A studio that runs until the test ends.
pub struct Running {
    pub port: u16,
    pub token: String,
    pub folder: tempfile::TempDir,
    runtime: tokio::runtime::Runtime,
}

/// What was answered.
pub struct Answer {
    pub status: u16,
    pub body: Vec<u8>,
}

impl Answer {
    pub fn json(&self) -> Value {
        let text = String::from_utf8_lossy(&self.body);
        serde_json::from_str(&text).unwrap_or_else(|e| panic!("{e} in {text}"))
    }

    /// The code of a refusal.
    pub fn code(&self) -> String {
        self.json()["code"].as_str().unwrap_or_default().to_owned()
    }
}

impl Running {
    pub fn start() -> Self {
        Self::start_with(None)
    }

    pub fn start_with(file: Option<(&str, &str)>) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        if let Some((name, text)) = file {
            std::fs::write(folder.path().join(name), text).expect("a file");
        }
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(2)
            .enable_all()
            .build()
            .expect("a runtime");
        let options = StudioOptions {
            folder: folder.path().to_owned(),
            file: file.map(|(name, _)| name.to_owned()),
            page: None,
        };
        let serving = runtime.block_on(serve(options, 0)).expect("a free port");
        let address = serving.address();
        let (host, token) = address.split_once("/#token=").expect("a token");
        let port = host.rsplit(':').next().and_then(|p| p.parse().ok()).expect("a port");
        let token = token.to_owned();
        runtime.spawn(serving.run());
        Self { port, token, folder, runtime }
    }

    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Asks as the page does, with a client that somebody else wrote.
    pub fn ask(&self, method: &str, path: &str, body: Option<&Value>) -> Answer {
        let request = hyper::Request::builder()
            .method(method)
            .uri(path)
            .header("host", format!("127.0.0.1:{}", self.port))
            .header("x-kerfold-token", &self.token)
            .header("content-type", "application/json");
        let body = body.map(|body| body.to_string().into_bytes()).unwrap_or_default();
        let request = request.body(Full::<Bytes>::new(body.into())).expect("a request");
        let asking = async {
            let stream = tokio::net::TcpStream::connect(("127.0.0.1", self.port)).await;
            let stream = TokioIo::new(stream.expect("a connection"));
            let (mut sender, connection) = http1::handshake(stream).await.expect("a server");
            tokio::spawn(connection);
            let answer = sender.send_request(request).await.expect("an answer");
            let status = answer.status().as_u16();
            let body = answer.into_body().collect().await.expect("a body").to_bytes().to_vec();
            Answer { status, body }
        };
        let most = Duration::from_secs(300);
        let runtime = self.runtime.handle();
        runtime.block_on(async { tokio::time::timeout(most, asking).await }).expect("in time")
    }

    pub fn get(&self, path: &str) -> Answer {
        self.ask("GET", path, None)
    }

    pub fn post(&self, path: &str, body: &Value) -> Answer {
        self.ask("POST", path, Some(body))
    }

    /// Says exactly this, and hears what comes back.
    pub fn say(&self, text: &str) -> Answer {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).expect("a connection");
        stream.set_read_timeout(Some(Duration::from_secs(20))).expect("a limit");
        stream.write_all(text.as_bytes()).expect("room");
        let mut heard = Vec::new();
        let _ = stream.read_to_end(&mut heard);
        let end = heard.windows(4).position(|w| w == b"\r\n\r\n").map_or(heard.len(), |at| at + 4);
        let head = String::from_utf8_lossy(&heard[..end]).into_owned();
        let status = head.split(' ').nth(1).and_then(|s| s.parse().ok()).unwrap_or_default();
        Answer { status, body: heard[end..].to_vec() }
    }

    /// A new tab's address.
    pub fn tab(&self) -> String {
        let told = self.post("/api/tabs", &serde_json::json!({ "resume": null }));
        assert_eq!(told.status, 200, "{}", String::from_utf8_lossy(&told.body));
        format!("/api/tabs/{}", told.json()["tab"].as_str().expect("a name"))
    }
}
