use super::*;

/// A folder of its own for a test, removed at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let folder =
            std::env::temp_dir().join(format!("kerfold-output-{}-{name}", std::process::id()));
        drop(fs::remove_dir_all(&folder));
        fs::create_dir_all(&folder).expect("a temporary folder");
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// All names in the folder, hidden ones too.
    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).expect("the folder");
        let mut names: Vec<_> = entries
            .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).expect("a file")
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        drop(fs::remove_dir_all(&self.0));
    }
}

#[test]
fn a_file_is_written_and_replaced_and_nothing_else_is_left() {
    let scratch = Scratch::new("file");
    write_file(&scratch.path("a"), b"first").expect("written");
    write_file(&scratch.path("a"), b"second").expect("replaced");
    assert_eq!((scratch.names(), scratch.text("a")), (vec!["a".to_owned()], "second".to_owned()));
}

#[test]
fn what_is_in_the_way_is_named_and_nothing_is_left_behind() {
    let scratch = Scratch::new("way");
    fs::create_dir(scratch.path("folder")).expect("a folder");
    fs::write(scratch.path("file"), "old").expect("a file");
    let error = |name: &str| write_file(&scratch.path(name), b"x").expect_err("refused");
    assert!(matches!(error("folder"), IoError::IsFolder { .. }));
    assert!(matches!(error("missing/a"), IoError::NoFolder { .. }));
    assert!(matches!(error("missing/deeper/a"), IoError::NoFolder { .. }));
    let in_file = error("file/a");
    assert!(matches!(in_file, IoError::NotAFolder { .. }));
    assert!(
        in_file.to_string().ends_with("file is a file, not a folder; choose another place"),
        "{in_file}"
    );
    assert!(matches!(error("file/deeper/a"), IoError::NotAFolder { .. }));
    assert_eq!(
        (scratch.names(), scratch.text("file")),
        (vec!["file".to_owned(), "folder".to_owned()], "old".to_owned())
    );
}

#[test]
fn a_write_protected_file_is_left_alone() {
    let scratch = Scratch::new("protected");
    fs::write(scratch.path("a"), "old").expect("a file");
    let mut permissions = fs::metadata(scratch.path("a")).expect("there").permissions();
    permissions.set_readonly(true);
    fs::set_permissions(scratch.path("a"), permissions).expect("set");
    assert!(matches!(write_file(&scratch.path("a"), b"new"), Err(IoError::WriteProtected { .. })));
    assert_eq!(scratch.text("a"), "old");
}

#[cfg(target_os = "linux")]
#[test]
fn what_the_system_refuses_is_told_and_devices_are_written_to() {
    let refused = write_file(Path::new("/proc/kerfold"), b"x").expect_err("refused");
    assert!(matches!(refused, IoError::Unwritable { .. }), "{refused}");
    let mut folder = OutputFolder::new("/proc/kerfold/sheets");
    folder.add("a", "x");
    assert!(matches!(folder.commit(), Err(IoError::Unwritable { .. })));
    write_file(Path::new("/dev/null"), b"x").expect("swallowed");
    assert!(!fs::metadata("/dev/null").expect("still there").is_file());
}

#[cfg(unix)]
#[test]
fn links_stay_links_and_permissions_stay() {
    use std::os::unix::fs::PermissionsExt as _;
    let scratch = Scratch::new("link");
    fs::write(scratch.path("real"), "old").expect("a file");
    fs::set_permissions(scratch.path("real"), fs::Permissions::from_mode(0o640)).expect("set");
    std::os::unix::fs::symlink("real", scratch.path("link")).expect("a link");
    write_file(&scratch.path("link"), b"new").expect("written");
    assert!(scratch.path("link").is_symlink());
    assert_eq!(scratch.text("real"), "new");
    let mode = fs::metadata(scratch.path("real")).expect("there").permissions().mode();
    assert_eq!(mode & 0o777, 0o640);
}

#[test]
fn a_folder_is_made_and_filled_at_once() {
    let scratch = Scratch::new("folder");
    let mut folder = OutputFolder::new(scratch.path("out/deep"));
    folder.add("a.svg", "one");
    folder.add("b.svg", vec![1, 2]);
    folder.add("a.svg", "two");
    assert_eq!(folder.names().collect::<Vec<_>>(), ["a.svg", "b.svg"]);
    assert!(scratch.names().is_empty());
    let written = folder.commit().expect("written");
    assert!(written.stale.is_empty());
    assert_eq!(written.paths, [scratch.path("out/deep/a.svg"), scratch.path("out/deep/b.svg")]);
    assert_eq!(scratch.text("out/deep/a.svg"), "two");
}

#[test]
fn all_files_or_none_and_old_ones_come_back() {
    let scratch = Scratch::new("none");
    fs::write(scratch.path("a"), "old").expect("a file");
    fs::create_dir(scratch.path("c")).expect("a folder");
    let mut folder = OutputFolder::new(&scratch.0);
    for name in ["a", "b", "c"] {
        folder.add(name, "new");
    }
    assert!(matches!(folder.clone().commit(), Err(IoError::IsFolder { .. })));
    assert_eq!(
        (scratch.names(), scratch.text("a")),
        (vec!["a".to_owned(), "c".to_owned()], "old".to_owned())
    );
    let mut made = OutputFolder::new(scratch.path("a/sheets"));
    made.add("x", "new");
    assert!(matches!(made.commit(), Err(IoError::NotAFolder { .. })));
    let mut nested = OutputFolder::new(scratch.path("new/folder"));
    nested.add("missing/x", "new");
    assert!(nested.commit().is_err());
    assert_eq!(scratch.names(), ["a", "c"]);
}

#[test]
fn a_rename_that_fails_undoes_the_ones_before() {
    let scratch = Scratch::new("undo");
    fs::write(scratch.path("a"), "old").expect("a file");
    let stage = |name: &str| {
        let target = Target::of(&scratch.path(name)).expect("a place");
        Staged::write(target, b"new").expect("staged")
    };
    let staged = vec![stage("a"), stage("b"), stage("c")];
    // Something gets in the way between staging and renaming.
    fs::create_dir_all(scratch.path("c/full")).expect("a folder");
    assert!(matches!(publish_all(staged), Err(IoError::Unwritable { .. })));
    assert_eq!(
        (scratch.names(), scratch.text("a")),
        (vec!["a".to_owned(), "c".to_owned()], "old".to_owned())
    );
}

#[test]
fn files_of_an_earlier_run_are_named_and_removed_and_those_of_others_stay() {
    let scratch = Scratch::new("stale");
    let ours = "<!-- kerfold unfold model.obj -o out -->";
    for (name, text) in [
        ("sheet-01.svg", ours),
        ("sheet-02.svg", ours),
        ("sheet-02.png", "a picture"),
        ("sheet-03.svg", "drawn by hand"),
        ("sheet-03.png", "a picture of that"),
        ("P01.dxf", ours),
        ("kerf.svg", ours),
    ] {
        fs::write(scratch.path(name), text).expect("a file");
    }
    // The command line of a PDF stands near its end.
    fs::write(scratch.path("sheet-04.pdf"), format!("{}{ours}", "%".repeat(100_000))).expect("one");
    let mut folder = OutputFolder::new(&scratch.0);
    folder.add("sheet-01.svg", "new");
    let written = folder.commit().expect("written");
    let stale = ["P01.dxf", "sheet-02.png", "sheet-02.svg", "sheet-04.pdf"];
    assert_eq!(written.stale, stale.map(|name| scratch.path(name)));
    written.remove_stale().expect("removed");
    assert_eq!(scratch.names(), ["kerf.svg", "sheet-01.svg", "sheet-03.png", "sheet-03.svg"]);
}

#[test]
fn several_files_come_together_or_not_at_all_and_leftovers_are_no_obstacle() {
    let scratch = Scratch::new("several");
    fs::write(scratch.path(".kerfold-1-0.tmp"), "of a run that was killed").expect("a file");
    fs::write(scratch.path("a"), "old").expect("a file");
    fs::create_dir(scratch.path("b")).expect("a folder");
    let files = |names: [&str; 2]| names.map(|name| (scratch.path(name), b"new".to_vec()));
    assert!(matches!(write_files(&files(["a", "b"])), Err(IoError::IsFolder { .. })));
    assert_eq!(scratch.text("a"), "old");
    write_files(&files(["a", "c"])).expect("written");
    assert_eq!((scratch.text("a"), scratch.text("c")), ("new".into(), "new".into()));
    assert_eq!(scratch.names(), [".kerfold-1-0.tmp", "a", "b", "c"]);
}

#[cfg(unix)]
#[test]
fn new_files_have_the_usual_permissions() {
    use std::os::unix::fs::PermissionsExt as _;
    let scratch = Scratch::new("mode");
    write_file(&scratch.path("ours"), b"x").expect("written");
    fs::write(scratch.path("usual"), "x").expect("a file");
    let mode = |name| fs::metadata(scratch.path(name)).expect("there").permissions().mode();
    assert_eq!(mode("ours"), mode("usual"));
}
