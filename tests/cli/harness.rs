//! How tests call the program: a folder of their own, and what a run left behind.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A folder that goes with the test.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("kerfold-cli-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("a folder for the test");
        Self(path)
    }

    pub fn path(&self, name: &str) -> String {
        self.0.join(name).to_str().expect("a plain path").to_owned()
    }

    /// Everything in it, with its bytes; folders without.
    pub fn contents(&self) -> Vec<(PathBuf, Option<Vec<u8>>)> {
        fn collect(folder: &Path, found: &mut Vec<(PathBuf, Option<Vec<u8>>)>) {
            for entry in fs::read_dir(folder).expect("a folder") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    collect(&path, found);
                    found.push((path, None));
                } else {
                    let bytes = fs::read(&path).expect("a file");
                    found.push((path, Some(bytes)));
                }
            }
        }
        let mut found = Vec::new();
        collect(&self.0, &mut found);
        found.sort();
        found
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

pub struct Ran {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl Ran {
    /// All that was printed.
    pub fn text(&self) -> String {
        format!("{}{}", self.out, self.err)
    }
}

pub fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_kerfold"));
    command.stdin(Stdio::null());
    command
}

pub fn run(arguments: &[&str]) -> Ran {
    ran(program().args(arguments))
}

pub fn ran(command: &mut Command) -> Ran {
    let output = command.output().expect("the program starts");
    Ran {
        code: output.status.code(),
        out: String::from_utf8(output.stdout).expect("UTF-8"),
        err: String::from_utf8(output.stderr).expect("UTF-8"),
    }
}

pub fn piped(arguments: &[&str], input: &str) -> Ran {
    let mut command = program();
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    child.stdin.take().expect("a pipe").write_all(input.as_bytes()).expect("the program reads");
    let output = child.wait_with_output().expect("the program ends");
    Ran {
        code: output.status.code(),
        out: String::from_utf8(output.stdout).expect("UTF-8"),
        err: String::from_utf8(output.stderr).expect("UTF-8"),
    }
}

pub fn good_model(folder: &Folder) -> String {
    let model = folder.path("model.obj");
    let made = run(&["solid", "dodecahedron", "--size", "100mm", "-o", &model]);
    assert_eq!((made.code, made.err.as_str()), (Some(0), ""), "{}", made.out);
    model
}

/// The verbs that the help lists, those of `cut` with it.
pub fn verbs() -> Vec<Vec<String>> {
    let listed = |of: &[&str]| -> Vec<String> {
        let help = run(&[of, &["--help"]].concat());
        assert_eq!(help.code, Some(0), "{of:?}");
        let commands = help.out.split("Commands:\n").nth(1).expect("a list of verbs");
        let lines = commands
            .lines()
            .take_while(|l| !l.is_empty())
            .filter(|l| l.starts_with("  ") && !l.starts_with("   "));
        lines.filter_map(|l| l.split_whitespace().next().map(str::to_owned)).collect()
    };
    let mut all: Vec<Vec<String>> = listed(&[]).into_iter().map(|v| vec![v]).collect();
    all.extend(listed(&["cut"]).into_iter().map(|v| vec!["cut".to_owned(), v]));
    all
}
