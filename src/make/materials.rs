//! Materials by name, from the bundled table and the user's own.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::code::codes;
use crate::io::read_text;
use crate::sheet::{Material, SheetError, SheetParams};
use crate::units::nearest_word;

/// The table that comes with the program.
const BUNDLED: &str = include_str!("materials.toml");

/// Why a material could not be taken.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MaterialError {
    /// No such name.
    #[error("there is no material `{name}`; {advice}")]
    Unknown {
        /// What was asked for.
        name: String,
        /// The nearest name, or all of them.
        advice: String,
    },
    /// A file of materials was named, but no material.
    #[error("{}: name the material of this file that is to be taken", path.display())]
    NoName {
        /// The file.
        path: PathBuf,
    },
    /// The file cannot be read.
    #[error("{} cannot be read ({source})", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file is no table of materials.
    #[error("{}: {message}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// Line, column and what is wrong.
        message: String,
    },
    /// A number outside its range.
    #[error("material `{name}`: {fault}")]
    Range {
        /// The material.
        name: String,
        /// The number.
        fault: SheetError,
    },
}

codes!(error MaterialError {
    Unknown = 731,
    NoName = 732,
    Unreadable = 733,
    Table = 734,
} through {
    Range.fault,
});

/// The material of a name: of the user's file first, where one is given, else of the bundled table.
///
/// # Errors
/// [`MaterialError`].
pub fn material(name: &str, file: Option<&Path>) -> Result<Material, MaterialError> {
    let mut table = read(BUNDLED, Path::new("the bundled table"))?;
    if let Some(path) = file {
        let unreadable = |source| MaterialError::Unreadable { path: path.to_owned(), source };
        table.extend(read(&read_text(path).map_err(unreadable)?, path)?);
    }
    let Some(found) = table.remove(name) else {
        let known = || table.keys().map(String::as_str);
        let advice = nearest_word(name, known()).map_or_else(
            || format!("known are {}", known().collect::<Vec<_>>().join(", ")),
            |near| format!("did you mean `{near}`?"),
        );
        return Err(MaterialError::Unknown { name: name.to_owned(), advice });
    };
    found.check().map_err(|fault| MaterialError::Range { name: name.to_owned(), fault })?;
    Ok(found)
}

fn read(text: &str, path: &Path) -> Result<BTreeMap<String, Material>, MaterialError> {
    toml::from_str(text).map_err(|error| {
        let at = error.span().map_or(0, |s| s.start).min(text.len());
        let line = text[..at].matches('\n').count() + 1;
        MaterialError::Table {
            path: path.to_owned(),
            message: format!("line {line}: {}", error.message()),
        }
    })
}

/// Sheet parameters with what their material decides; unchanged without a material. A file of
/// materials is looked for from `folder`.
///
/// # Errors
/// [`MaterialError`].
pub fn with_material(params: &SheetParams, folder: &Path) -> Result<SheetParams, MaterialError> {
    let file = params.stock.materials.as_ref().map(|path| folder.join(path));
    match (&params.stock.material, file) {
        (None, None) => Ok(params.clone()),
        (None, Some(path)) => Err(MaterialError::NoName { path }),
        (Some(name), file) => Ok(params.with_material(material(name, file.as_deref())?)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::{Joint, JointParams, LayerKind, StockParams};
    use crate::units::Length;

    #[test]
    fn every_bundled_material_is_sound() {
        let table = read(BUNDLED, Path::new("bundled")).expect("a sound table");
        assert!(table.len() >= 10);
        for (name, material) in &table {
            assert_eq!(material.check(), Ok(()), "{name}");
            assert!(material.kerf < material.web, "{name}");
        }
    }

    #[test]
    fn a_material_gives_kerf_thickness_and_speeds_where_nothing_else_is_said() {
        let params = SheetParams {
            stock: StockParams { material: Some("ply3".to_owned()), ..StockParams::default() },
            ..SheetParams::default()
        };
        let made = with_material(&params, Path::new("")).expect("bundled");
        assert_eq!((made.stock.kerf.mm(), made.joint.thickness), (0.2, None));
        assert_eq!((made.speed(LayerKind::Score), made.speed(LayerKind::Info)), (Some(60.0), None));
        let params = SheetParams {
            joint: JointParams { kind: Joint::Fingers, ..params.joint },
            stock: StockParams { kerf: Length::from_mm(0.3), ..params.stock },
            ..params
        };
        let made = with_material(&params, Path::new("")).expect("bundled");
        assert_eq!((made.stock.kerf.mm(), made.joint.thickness.map(Length::mm)), (0.3, Some(3.0)));
    }

    #[test]
    fn unknown_names_get_advice_and_bad_tables_a_line() {
        let text = material("plyy3", None).expect_err("unknown").to_string();
        assert!(text.contains("did you mean `ply"), "{text}");
        let params = SheetParams {
            stock: StockParams { materials: Some("mine.toml".into()), ..StockParams::default() },
            ..SheetParams::default()
        };
        assert!(
            with_material(&params, Path::new(""))
                .expect_err("no name")
                .to_string()
                .contains("that is to be taken")
        );
        let own = "[felt]\ntitle = \"Felt\"\nthickness = \"3mm\"\nkerf = \"0.3mm\"\nweb = \"3mm\"\n\
                   speed = { cut = 30, score = 50, engrave = 100, travel = 300 }\ncolours = { cut-outer = \"#00FFFF\" }\n";
        assert!(read(own, Path::new("mine.toml")).is_ok());
        for (from, to, what) in [
            ("kerf", "kurf", "line 4"),
            ("#00FFFF", "cyan", "#FF0000"),
            ("cut = 30", "cut = \"fast\"", "line 6"),
        ] {
            let text =
                read(&own.replace(from, to), Path::new("mine.toml")).expect_err(from).to_string();
            assert!(text.starts_with("mine.toml: ") && text.contains(what), "{text}");
        }
    }
}
