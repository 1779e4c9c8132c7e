//! The guide is a test: its commands are read out of the page and run one after the other, and say
//! what the page shows.

use std::path::Path;
use std::process::Command;

const PAGE: &str = "docs/guide.md";

/// A command with the output that the page shows under it.
struct Shown {
    command: String,
    output: Vec<String>,
}

/// The commands of all blocks marked `console`, in order.
fn shown(page: &str) -> Vec<Shown> {
    let mut all: Vec<Shown> = Vec::new();
    let mut is_inside = false;
    for line in page.lines() {
        match (is_inside, line.strip_prefix("$ ")) {
            _ if line.starts_with("```") => is_inside = line == "```console",
            (true, Some(command)) => {
                all.push(Shown { command: command.to_owned(), output: Vec::new() })
            }
            (true, None) => {
                all.last_mut().expect("a block begins with a command").output.push(line.to_owned())
            }
            (false, _) => {}
        }
    }
    all
}

/// The words of a command; single quotes keep what is inside together.
fn words(command: &str) -> Vec<String> {
    let mut words = Vec::new();
    for (i, part) in command.split('\'').enumerate() {
        if i % 2 == 1 {
            words.push(part.to_owned());
        } else {
            words.extend(part.split_whitespace().map(str::to_owned));
        }
    }
    words
}

/// Whether a line is as shown; `…` stands for any text.
fn is_like(shown: &str, line: &str) -> bool {
    let mut parts = shown.split('…');
    let first = parts.next().unwrap_or_default();
    let Some(mut rest) = line.strip_prefix(first) else { return false };
    let mut is_open = false;
    for part in parts {
        let Some(at) = (if part.is_empty() { Some(rest.len()) } else { rest.find(part) }) else {
            return false;
        };
        (rest, is_open) = (&rest[at + part.len()..], part.is_empty());
    }
    is_open || rest.is_empty()
}

/// Whether the output is as shown; a line `…` stands for any lines.
fn agrees(shown: &[String], lines: &[&str]) -> bool {
    match (shown.split_first(), lines.split_first()) {
        (None, None) => true,
        (Some((first, more)), _) if first == "…" => {
            (0..=lines.len()).any(|skip| agrees(more, &lines[skip..]))
        }
        (Some((first, more)), Some((line, rest))) => is_like(first, line) && agrees(more, rest),
        _ => false,
    }
}

fn run(command: &str, folder: &Path) -> String {
    let words = words(command);
    let (program, arguments) = words.split_first().expect("a command");
    assert_eq!(program, "kerfold", "{command}");
    let done = Command::new(env!("CARGO_BIN_EXE_kerfold"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("kerfold");
    assert!(
        done.status.code().is_some_and(|code| code < 2),
        "{command}: {}",
        String::from_utf8_lossy(&done.stderr)
    );
    String::from_utf8_lossy(&done.stderr).into_owned() + &String::from_utf8_lossy(&done.stdout)
}

#[test]
fn the_commands_of_the_guide_say_what_it_shows() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("guide");
    std::fs::remove_dir_all(&folder).ok();
    std::fs::create_dir_all(&folder).expect("a folder");
    let page = std::fs::read_to_string(PAGE).expect("the guide");
    let all = shown(&page);
    assert!(all.len() >= 15, "the guide has {} commands", all.len());
    for Shown { command, output } in all {
        let said = run(&command, &folder);
        let lines: Vec<&str> = said.lines().map(str::trim_end).collect();
        assert!(!output.is_empty(), "the guide shows nothing under: {command}\n{said}");
        assert!(agrees(&output, &lines), "{command}\nshown:\n{}\nsaid:\n{said}", output.join("\n"));
    }
}

#[test]
fn planted_differences_are_found() {
    let lines = ["2 pieces", "proof: 8.5e-14 mm, 0 overlaps"];
    let shown = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    assert!(agrees(&shown("2 pieces\nproof: … mm, 0 overlaps"), &lines));
    assert!(agrees(&shown("…\nproof: …"), &lines));
    assert!(!agrees(&shown("3 pieces\n…"), &lines));
    assert!(!agrees(&shown("2 pieces\nproof: … mm, 1 overlaps"), &lines));
    assert!(!agrees(&shown("2 pieces"), &lines));
}
