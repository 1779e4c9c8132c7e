//! Every crate that goes into the program has a licence that deny.toml allows. `cargo deny check`
//! says more, where it is installed.

use std::process::Command;

/// The list `allow` of deny.toml.
fn allowed() -> Vec<String> {
    let text = std::fs::read_to_string("deny.toml").expect("deny.toml");
    let table: toml::Table = text.parse().expect("TOML");
    let list = table["licenses"]["allow"].as_array().expect("a list");
    list.iter().map(|name| name.as_str().expect("a name").to_owned()).collect()
}

/// Whether a licence expression can be met: `OR` and `/` offer a choice, `AND` asks for both.
fn is_met(expression: &str, allowed: &[String]) -> bool {
    let text = expression.replace('/', " OR ");
    let all = |part: &str| {
        part.split(" AND ")
            .all(|one| allowed.iter().any(|a| a == one.trim().trim_matches(['(', ')'])))
    };
    // An `AND` with a choice in brackets: each bracket on its own.
    match text.split_once(") AND ") {
        Some((choice, rest)) => {
            is_met(choice.trim_start_matches('('), allowed) && is_met(rest, allowed)
        }
        None => text.split(" OR ").any(all),
    }
}

/// What cargo knows about the crates for this machine.
fn metadata() -> serde_json::Value {
    let host = Command::new("rustc").arg("-vV").output().expect("rustc");
    let host = String::from_utf8(host.stdout).expect("text");
    let host = host.lines().find_map(|l| l.strip_prefix("host: ")).expect("a host");
    let done = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--locked", "--filter-platform", host])
        .output()
        .expect("cargo");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    serde_json::from_slice(&done.stdout).expect("JSON")
}

#[test]
fn every_dependency_has_a_licence_that_is_allowed() {
    let allowed = allowed();
    let metadata = metadata();
    let packages = metadata["packages"].as_array().expect("packages");
    assert!(packages.len() > 50);
    for package in packages {
        let licence = package["license"].as_str().unwrap_or("none");
        assert!(is_met(licence, &allowed), "{} {}: {licence}", package["name"], package["version"]);
    }
}

/// The Rust version that Cargo.toml promises is not older than what a dependency says it needs.
/// Calls into the standard library are held against it by a lint of clippy.
#[test]
fn no_dependency_needs_a_newer_rust_than_we_say() {
    let metadata = metadata();
    let packages = metadata["packages"].as_array().expect("packages");
    let version = |package: &serde_json::Value| {
        let text = package["rust_version"].as_str().unwrap_or("0");
        text.split('.')
            .map(|n| n.parse::<u32>().expect("a number"))
            .chain([0, 0])
            .take(3)
            .collect::<Vec<_>>()
    };
    let ours = packages.iter().find(|p| p["name"] == "kerfold").map(version).expect("kerfold");
    assert!(ours > vec![1, 0, 0], "no rust-version");
    for package in packages {
        assert!(
            version(package) <= ours,
            "{} needs Rust {}",
            package["name"],
            package["rust_version"]
        );
    }
}

#[test]
fn expressions_are_understood() {
    let allowed = ["MIT", "Unicode-3.0"].map(str::to_owned);
    assert!(is_met("MIT OR GPL-3.0", &allowed) && is_met("Apache-2.0/MIT", &allowed));
    assert!(is_met("(MIT OR Apache-2.0) AND Unicode-3.0", &allowed));
    assert!(!is_met("GPL-3.0", &allowed) && !is_met("MIT AND GPL-3.0", &allowed));
    assert!(!is_met("(MIT OR Apache-2.0) AND GPL-3.0", &allowed) && !is_met("none", &allowed));
}
