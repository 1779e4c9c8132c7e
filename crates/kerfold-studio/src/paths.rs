//! Files of the studio lie in one folder; this is the only place that turns a name into a path.

use std::path::{Component, Path, PathBuf};

use kerfold::recipe::{RecipeDraft, StepDraft, Value};

use crate::StudioError;

/// The path of a name in the folder; the file need not exist.
///
/// # Errors
/// [`StudioError::Outside`] for what is absolute, goes up, or leads out by a link.
pub(crate) fn inside(root: &Path, name: &str) -> Result<PathBuf, StudioError> {
    let outside = || StudioError::Outside { path: name.chars().take(200).collect() };
    let path = Path::new(name);
    let is_plain = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    if name.contains(['\0', '\\']) || !path.components().all(is_plain) {
        return Err(outside());
    }
    let full = root.join(path);
    // The nearest folder or file that exists must lie inside, wherever links lead.
    let existing = full.ancestors().find(|ancestor| ancestor.symlink_metadata().is_ok());
    let real = existing.and_then(|path| path.canonicalize().ok()).ok_or_else(outside)?;
    if real.starts_with(root) { Ok(full) } else { Err(outside()) }
}

/// Refuses a step that names a file outside the folder, by itself or by parameters of its recipe.
/// Every text is looked at as reading it sees it, whatever key it belongs to, so that no new key can
/// be forgotten.
pub(crate) fn check_step(
    root: &Path,
    step: &StepDraft,
    parameters: &[(String, Value)],
) -> Result<(), StudioError> {
    let filled = step.filled(parameters)?;
    filled.entries().iter().try_for_each(|(_, value)| check_value(root, value))
}

/// As [`check_step`] for all steps.
pub(crate) fn check_recipe(root: &Path, recipe: &RecipeDraft) -> Result<(), StudioError> {
    recipe.steps.iter().try_for_each(|step| check_step(root, step, &recipe.parameters))
}

fn check_value(root: &Path, value: &Value) -> Result<(), StudioError> {
    match value {
        Value::String(text) => {
            let path = Path::new(text);
            let goes_out = path.has_root()
                || path.components().any(|part| matches!(part, Component::ParentDir));
            if goes_out || root.join(path).symlink_metadata().is_ok() {
                inside(root, text).map(drop)
            } else {
                Ok(())
            }
        }
        Value::Array(values) => values.iter().try_for_each(|value| check_value(root, value)),
        Value::Table(table) => table.values().try_for_each(|value| check_value(root, value)),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_leads_out_of_the_folder() {
        let folder = tempfile::tempdir().expect("a folder");
        let root = folder.path().canonicalize().expect("a path");
        std::fs::write(root.join("a.obj"), "").expect("a file");
        std::fs::create_dir(root.join("sub")).expect("a folder");
        for good in ["a.obj", "new.toml", "sub/b.toml", "./a.obj", "sub/new/c.svg"] {
            assert!(inside(&root, good).is_ok(), "{good}");
        }
        for bad in ["../a.obj", "/etc/passwd", "sub/../../a", "a\0b", "..\\a", ".."] {
            assert!(inside(&root, bad).is_err(), "{bad}");
        }
        let step = |text: &str| StepDraft::new("cut", "edge").with("select", text);
        for good in ["all", "sides=5", "along=z:5deg", "1/3", "3,7,10-14", "-x", "0.3"] {
            assert!(check_step(&root, &step(good), &[]).is_ok(), "{good}");
        }
        assert!(check_step(&root, &step("/etc/passwd"), &[]).is_err());
        let list = Value::Array(vec![Value::from("../x.obj")]);
        assert!(check_step(&root, &StepDraft::new("nest", list), &[]).is_err());
    }

    #[test]
    fn parameters_lead_nowhere_else_either() {
        let folder = tempfile::tempdir().expect("a folder");
        let root = folder.path().canonicalize().expect("a path");
        let given = |name: &str, value: &str| vec![(name.to_owned(), Value::from(value))];
        let read = |path: &str| StepDraft::new("read", path);
        for (path, name, value) in [
            ("{f}", "f", "/etc/passwd"),
            ("{e}/etc/passwd", "e", ""),
            ("{p}{p}/model.obj", "p", "."),
        ] {
            let refused = check_step(&root, &read(path), &given(name, value));
            assert!(matches!(refused, Err(StudioError::Outside { .. })), "{path} {value}");
        }
        assert!(check_step(&root, &read("{f}.obj"), &given("f", "model")).is_ok());
        assert!(check_step(&root, &read("{g}.obj"), &given("f", "model")).is_err(), "no such one");
    }

    #[cfg(unix)]
    #[test]
    fn links_that_lead_out_are_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let other = tempfile::tempdir().expect("a folder");
        std::fs::write(other.path().join("secret.obj"), "").expect("a file");
        let root = folder.path().canonicalize().expect("a path");
        let link = |to: &Path, name: &str| {
            std::os::unix::fs::symlink(to, root.join(name)).expect("a link");
        };
        link(other.path(), "out");
        link(&other.path().join("secret.obj"), "model.obj");
        link(Path::new("/nowhere/at/all"), "dangling");
        for bad in ["out/secret.obj", "out/new.toml", "model.obj", "dangling"] {
            assert!(inside(&root, bad).is_err(), "{bad}");
            assert!(check_value(&root, &Value::from(bad)).is_err(), "{bad}");
        }
    }
}
