//! Whatever the number of threads, the bytes are the same.

use std::fs;

use super::harness::{Folder, program, ran};

/// What a run leaves in its folder, with so many threads.
fn made(folder: &Folder, arguments: &[&str], threads: usize) -> Vec<(String, Vec<u8>)> {
    let out = folder.path("out");
    let _ = fs::remove_dir_all(&out);
    fs::create_dir(&out).expect("a folder");
    let mut command = program();
    command.args(arguments).current_dir(&folder.0).env("RAYON_NUM_THREADS", threads.to_string());
    let ran = ran(&mut command);
    assert!(matches!(ran.code, Some(0 | 1)), "{arguments:?}: {}", ran.err);
    let files = folder.contents().into_iter().filter(|(path, _)| path.starts_with(&out));
    let name = |path: std::path::PathBuf| path.to_string_lossy().into_owned();
    let mut files: Vec<_> = files.filter_map(|(path, bytes)| Some((name(path), bytes?))).collect();
    files.push(("printed".to_owned(), ran.text().into_bytes()));
    files
}

#[test]
fn the_same_bytes_with_any_number_of_threads() {
    let folder = Folder::new("threads");
    let model = folder.path("model.obj");
    let solid = ran(program().args(["solid", "soccer-ball", "--size", "500mm", "-o", &model]));
    assert_eq!(solid.code, Some(0), "{}", solid.err);
    let jobs: &[&[&str]] = &[
        &[
            "unfold",
            "model.obj",
            "--pieces",
            "faces",
            "--sheet",
            "a3",
            "--part-files",
            "on",
            "--tile",
            "a4",
            "--format",
            "svg,dxf,pdf,lbrn2",
            "-o",
            "out",
        ],
        &["panels", "model.obj", "--thickness", "6mm", "--sheet", "600x400", "-o", "out"],
        &["render", "model.obj", "--colour", "valence", "--ids", "faces", "-o", "out/a.png"],
        &["check", "model.obj", "--profile", "glass", "--report", "out/report.html"],
        &["panelize", "model.obj", "--count", "40", "-o", "out/panels.obj"],
    ];
    for arguments in jobs {
        let alone = made(&folder, arguments, 1);
        assert!(alone.len() > 1 && alone.iter().all(|(_, bytes)| !bytes.is_empty()));
        for threads in [2, 5] {
            let shared = made(&folder, arguments, threads);
            let names = |files: &[(String, Vec<u8>)]| -> Vec<String> {
                files.iter().map(|(name, _)| name.clone()).collect()
            };
            assert_eq!(names(&alone), names(&shared), "{arguments:?}");
            for ((name, one), (_, other)) in alone.iter().zip(&shared) {
                assert!(one == other, "{arguments:?}, {threads} threads: {name} differs");
            }
        }
    }
}
