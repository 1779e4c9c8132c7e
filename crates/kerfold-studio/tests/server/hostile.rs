//! What pages of others, and broken programs, may try: each refused with its code.

use std::time::{Duration, Instant};

use serde_json::json;

use super::harness::Running;

/// A request with these lines in its head, and the connection closed after it.
fn request(first: &str, lines: &[String]) -> String {
    format!("{first} HTTP/1.1\r\n{}\r\nConnection: close\r\n\r\n", lines.join("\r\n"))
}

#[test]
fn other_hosts_and_origins_and_missing_tokens_are_refused() {
    let studio = Running::start();
    let host = format!("Host: 127.0.0.1:{}", studio.port);
    let token = format!("x-kerfold-token: {}", studio.token);
    let refused = |first: &str, lines: &[&str]| {
        let lines: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
        let answer = studio.say(&request(first, &lines));
        (answer.status, answer.code())
    };
    let get = "GET /api/schema";
    // A name that was rebound to this machine, with and without our port.
    let rebound = format!("Host: evil.example:{}", studio.port);
    for host in [rebound.as_str(), "Host: evil.example", "Host: 127.0.0.1", "Host: 127.0.0.1:1"] {
        assert_eq!(refused(get, &[host, &token]), (421, "E901".into()), "{host}");
        assert_eq!(refused("GET /", &[host]), (421, "E901".into()), "{host}");
    }
    for origin in ["http://evil.example", "null", "https://127.0.0.1", "http://127.0.0.1:1"] {
        let origin = format!("Origin: {origin}");
        assert_eq!(refused(get, &[&host, &origin, &token]), (403, "E902".into()), "{origin}");
    }
    let wrong = format!("x-kerfold-token: {}", "0".repeat(32));
    let short = format!("x-kerfold-token: {}", &studio.token[..31]);
    for token in ["Accept: */*", &wrong, &short, "x-kerfold-token: "] {
        assert_eq!(refused(get, &[&host, token]), (401, "E903".into()), "{token}");
    }
    let by_query = format!("GET /api/schema?token={}", studio.token);
    let own = format!("Origin: http://127.0.0.1:{}", studio.port);
    for first in [by_query.as_str(), get] {
        let lines = [host.clone(), own.clone(), token.clone()];
        assert_eq!(studio.say(&request(first, &lines)).status, 200);
    }
    assert_eq!(refused("DELETE /api/tabs/x/work", &[&host]), (401, "E903".into()));
    assert_eq!(studio.get("/api/tabs/nowhere").code(), "E906");
    assert_eq!(studio.get("/api/nothing").code(), "E908");
    assert_eq!(studio.get("/../Cargo.toml").status, 404);
}

#[test]
fn no_file_outside_the_folder_is_read_or_written() {
    let studio = Running::start();
    let outside = tempfile::tempdir().expect("a folder");
    let secret = outside.path().join("secret.obj");
    std::fs::write(&secret, "v 0 0 0\n").expect("a file");
    let secret = secret.to_str().expect("text");
    let tab = studio.tab();
    let refused = |method: &str, path: &str, body: serde_json::Value| {
        let answer = studio.ask(method, path, Some(&body));
        assert_eq!((answer.status, answer.code()), (403, "E904".into()), "{method} {path} {body}");
    };
    for bad in [secret, "../secret.obj", "/etc/passwd", "a/../../b.obj"] {
        refused("PUT", &format!("{tab}/recipe"), json!({ "file": bad }));
        let read = format!("[[step]]\nread = \"{bad}\"\n");
        refused("PUT", &format!("{tab}/recipe"), json!({ "text": read }));
        refused("POST", &format!("{tab}/steps"), json!({ "step": [["read", bad]] }));
        let list = json!({ "step": [["nest", [bad]]] });
        refused("POST", &format!("{tab}/steps"), list);
        let step = json!([["solid", "cube"], ["size", bad]]);
        refused("POST", &format!("{tab}/preview"), json!({ "step": step, "steps": 0 }));
    }
    studio.post(&format!("{tab}/steps"), &json!({ "step": [["solid", "cube"]] }));
    studio.post(&format!("{tab}/steps"), &json!({ "step": [["unfold", "auto"]] }));
    for bad in ["/tmp/x.glb", "../x.glb"] {
        let body = json!({ "key": "animate", "value": bad });
        refused("PATCH", &format!("{tab}/steps/2"), body);
        refused("POST", &format!("{tab}/export"), json!({ "folder": bad }));
        refused("POST", &format!("{tab}/save"), json!({ "file": bad }));
    }
    let encoded = studio.ask("PUT", "/api/files/..%2F..%2Fx.obj", Some(&json!({})));
    assert_eq!(encoded.code(), "E904");
    for bad in [".bashrc", "run.sh", "sub%2Fx.obj"] {
        let answer = studio.ask("PUT", &format!("/api/files/{bad}"), Some(&json!({})));
        assert_eq!(answer.code(), "E913", "{bad}");
    }
    for bad in [".hidden.toml", "x.sh", "sub/x.toml"] {
        let answer = studio.post(&format!("{tab}/save"), &json!({ "file": bad }));
        assert_eq!(answer.code(), "E913", "{bad}");
    }
}

#[cfg(unix)]
#[test]
fn links_out_of_the_folder_are_not_followed() {
    let studio = Running::start();
    let outside = tempfile::tempdir().expect("a folder");
    std::os::unix::fs::symlink(outside.path(), studio.path().join("out")).expect("a link");
    let tab = studio.tab();
    studio.post(&format!("{tab}/steps"), &json!({ "step": [["solid", "cube"]] }));
    let answer = studio.post(&format!("{tab}/export"), &json!({ "folder": "out" }));
    assert_eq!(answer.code(), "E904");
    assert_eq!(std::fs::read_dir(outside.path()).expect("a folder").count(), 0);
}

#[test]
fn huge_and_broken_bodies_are_refused() {
    let studio = Running::start();
    let tab = studio.tab();
    let text = "x".repeat((1 << 20) + 1);
    let answer = studio.ask("PUT", &format!("{tab}/recipe"), Some(&json!({ "text": text })));
    assert_eq!((answer.status, answer.code()), (413, "E905".into()));
    // Told to be huge: refused before it is sent.
    let head = [
        format!("Host: 127.0.0.1:{}", studio.port),
        format!("x-kerfold-token: {}", studio.token),
        "Content-Length: 99999999999".to_owned(),
    ];
    let answer = studio.say(&request("PUT /api/files/huge.obj", &head));
    assert_eq!((answer.status, answer.code()), (413, "E905".into()));
    let bad = |body: serde_json::Value| studio.post(&format!("{tab}/steps"), &body).code();
    assert_eq!(bad(json!({})), "E909");
    assert_eq!(bad(json!({ "step": "cube" })), "E909");
    assert_eq!(bad(json!({ "step": [["solid", null]] })), "E909");
    assert_eq!(bad(json!({ "step": [] })), "E703");
    assert_eq!(bad(json!({ "step": [["solid", "kube"]] })), "E705");
    let deep = "[".repeat(100_000);
    let answer = studio.say(&format!(
        "{}{deep}",
        request(&format!("POST {tab}/steps"), &{
            let mut head = head.clone();
            head[2] = format!("Content-Length: {}", deep.len());
            head.to_vec()
        })
    ));
    assert_eq!(answer.code(), "E909");
}

#[test]
fn a_recipe_that_runs_for_hours_stops_when_nobody_waits_and_blocks_nobody() {
    let studio = Running::start();
    let tab = studio.tab();
    let steps = format!("{tab}/steps");
    // What is too large is refused before it begins.
    studio.post(&steps, &json!({ "step": [["solid", "dodecahedron"], ["size", "100mm"]] }));
    studio.post(&steps, &json!({ "step": [["menger", 40]] }));
    let refused = studio.get(&format!("{tab}/model"));
    assert_eq!(refused.status, 422, "{}", String::from_utf8_lossy(&refused.body));
    studio.ask("DELETE", &format!("{tab}/steps/2"), None);
    // A long nesting: 720 triangles, with much effort.
    let body = json!({ "key": "solid", "value": "geodesic-6" });
    studio.ask("PATCH", &format!("{tab}/steps/1"), Some(&body));
    let unfold = json!([["unfold", "faces"], ["sheet", "2000x2000"], ["nest_effort", 1000]]);
    let unfold = json!({ "step": unfold });
    let told = studio.post(&steps, &unfold);
    assert_eq!(told.status, 200, "{}", String::from_utf8_lossy(&told.body));
    std::thread::scope(|scope| {
        let long = scope.spawn(|| studio.get(&format!("{tab}/result")));
        std::thread::sleep(Duration::from_millis(500));
        let begin = Instant::now();
        assert_eq!(studio.get(&tab).status, 200);
        assert_eq!(studio.get("/api/files").status, 200);
        assert!(begin.elapsed() < Duration::from_secs(10), "others had to wait");
        assert_eq!(studio.ask("DELETE", &format!("{tab}/work"), None).status, 200);
        let answer = long.join().expect("an answer");
        assert_eq!((answer.status, answer.code()), (409, "E907".into()));
    });
}

#[test]
fn the_port_is_open_to_this_machine_alone() {
    let studio = Running::start();
    let addresses = std::net::UdpSocket::bind("0.0.0.0:0").and_then(|socket| {
        socket.connect("192.0.2.1:9")?;
        socket.local_addr()
    });
    if let Ok(address) = addresses
        && !address.ip().is_loopback()
    {
        let other = std::net::SocketAddr::new(address.ip(), studio.port);
        let reached = std::net::TcpStream::connect_timeout(&other, Duration::from_millis(500));
        assert!(reached.is_err(), "{other} is reached from outside");
    }
}
