//! A table of variants of one recipe: each line gives its parameters other values.
//!
//! Nothing runs here. A sweep is a list of commands that GNU parallel, make or a batch queue runs,
//! on as many machines as there are, and later the table of what they left in their folders.

use std::collections::HashSet;
use std::path::Path;

use serde_json::Value;

use super::{Recipe, RecipeError, shell_text};
use crate::code::codes;

/// The file in the folder of a result that says what is in it.
pub const MANIFEST: &str = "manifest.json";
/// The column whose cells name the folders.
const NAME: &str = "name";
/// Lines of a table at most: each is a run, and a folder.
pub const MOST_VARIANTS: usize = 100_000;

/// Why a table is no sweep of a recipe. Lines are counted from 1, the one of the names.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// Not a table of values separated by commas.
    #[error("{0}")]
    NotCsv(#[from] csv::Error),
    /// A head and nothing below it, or not even that.
    #[error(
        "the table has no variants; its first line names parameters of the recipe, and each \
        further line gives them values"
    )]
    NoVariants,
    /// More than a folder can hold in comfort.
    #[error("the table has more than {MOST_VARIANTS} variants; divide it")]
    TooMany,
    /// A column that appears twice.
    #[error("the column `{column}` appears twice; each parameter has one")]
    DoubleColumn {
        /// Its name.
        column: String,
    },
    /// A name that is none of a folder, or one that another line has.
    #[error("line {line}: `{name}` cannot be the name of a folder of its own; {advice}")]
    BadName {
        /// Where.
        line: u64,
        /// The name.
        name: String,
        /// What is wrong with it.
        advice: &'static str,
    },
    /// Values with which the recipe cannot be read.
    #[error("line {line}: {}", error.without_place())]
    BadVariant {
        /// Where.
        line: u64,
        /// What is wrong with them.
        error: Box<RecipeError>,
    },
    /// A manifest that kerfold has not written.
    #[error("{folder}/{MANIFEST} is no manifest of a run: {message}; run its command again")]
    BadManifest {
        /// The folder of the variant.
        folder: String,
        /// What is wrong with it.
        message: String,
    },
}

codes!(error SweepError {
    NotCsv = 771,
    NoVariants = 772,
    TooMany = 773,
    DoubleColumn = 774,
    BadName = 775,
    BadVariant = 776,
    BadManifest = 777,
});

/// One line of the table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Variant {
    /// The folder of its results, within that of the sweep: the cell of the column `name`, or the
    /// number of the variant, from 1, with zeros in front.
    pub folder: String,
    /// Parameters with their values, as the recipe would be told them; an empty cell leaves the
    /// parameter as the recipe has it.
    pub settings: Vec<(String, String)>,
}

/// Variants of one recipe.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sweep {
    /// The parameters, in the order of the columns.
    pub parameters: Vec<String>,
    /// The lines.
    pub variants: Vec<Variant>,
}

impl Sweep {
    /// Reads a table (CSV with a head; RFC 4180) of parameters of a recipe, given as text, and reads
    /// the recipe once with each line, so that no run fails for a misspelt value.
    ///
    /// # Errors
    /// [`SweepError`] for what is no table, for a line with which the recipe cannot be read, and for
    /// names that are no folders of their own.
    ///
    /// # Example
    /// ```
    /// use kerfold::recipe::Sweep;
    ///
    /// let recipe = "[parameters]\nsize = \"20mm\"\n[[step]]\nsolid = \"cube\"\nsize = \"{size}\"";
    /// let sweep = Sweep::parse("size\n10mm\n30mm\n", recipe)?;
    /// assert_eq!(
    ///     sweep.commands("cube.toml", "out")[1],
    ///     "kerfold run cube.toml --set size=30mm --manifest -o out/2"
    /// );
    /// # Ok::<(), kerfold::recipe::SweepError>(())
    /// ```
    pub fn parse(table: &str, recipe: &str) -> Result<Self, SweepError> {
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .from_reader(table.strip_prefix('\u{feff}').unwrap_or(table).as_bytes());
        let columns: Vec<String> = reader.headers()?.iter().map(str::to_owned).collect();
        let mut seen = HashSet::new();
        if let Some(column) = columns.iter().find(|&column| !seen.insert(column.as_str())) {
            return Err(SweepError::DoubleColumn { column: column.clone() });
        }
        let (mut variants, mut lines) = (Vec::new(), Vec::new());
        for record in reader.records() {
            let record = record?;
            if variants.len() == MOST_VARIANTS {
                return Err(SweepError::TooMany);
            }
            lines.push(record.position().map_or(0, csv::Position::line));
            variants.push(variant(&columns, &record));
        }
        if variants.is_empty() {
            return Err(SweepError::NoVariants);
        }
        let digits = variants.len().to_string().len();
        let is_named = columns.iter().any(|column| column == NAME);
        for (i, variant) in variants.iter_mut().enumerate().filter(|_| !is_named) {
            variant.folder = format!("{:0digits$}", i + 1);
        }
        check_names(&variants, &lines)?;
        for (variant, &line) in variants.iter().zip(&lines) {
            Recipe::parse_with(recipe, &variant.settings)
                .map_err(|error| SweepError::BadVariant { line, error: Box::new(error) })?;
        }
        let parameters = columns.into_iter().filter(|column| column != NAME).collect();
        Ok(Self { parameters, variants })
    }

    /// The command line of each variant, quoted for a shell: the recipe by the path or name that is
    /// given, results in folders below `folder`.
    pub fn commands(&self, recipe: &str, folder: &str) -> Vec<String> {
        let command = |variant: &Variant| {
            let mut words: Vec<String> = ["kerfold", "run", recipe].map(str::to_owned).into();
            for (name, value) in &variant.settings {
                words.extend(["--set".to_owned(), format!("{name}={value}")]);
            }
            let place = Path::new(folder).join(&variant.folder);
            let place = place.to_string_lossy().replace('\\', "/");
            words.extend(["--manifest".to_owned(), "-o".to_owned(), place]);
            shell_text(&words)
        };
        self.variants.iter().map(command).collect()
    }

    /// One table of all results, as CSV: for each variant its folder, its parameters, whether it has
    /// run, and every number and word of its manifest that is no list. `manifests` has the text of
    /// each, in the order of the variants; `None` where there is none yet. A manifest of other
    /// parameters is from before the table was changed, and counts as none.
    ///
    /// # Errors
    /// [`SweepError::BadManifest`].
    pub fn results(&self, manifests: &[Option<String>]) -> Result<SweepResults, SweepError> {
        let mut columns: Vec<String> = Vec::new();
        let mut rows: Vec<Row> = Vec::new();
        for (variant, text) in self.variants.iter().zip(manifests) {
            let row = match text {
                Some(text) => Row::read(variant, text)?,
                None => Row { state: NOT_RUN, cells: Vec::new() },
            };
            for (column, _) in &row.cells {
                if !columns.contains(column) {
                    columns.push(column.clone());
                }
            }
            rows.push(row);
        }
        let is_open = |(_, row): &(&Variant, &Row)| row.state != DONE;
        let first_open = self.variants.iter().zip(&rows).find(is_open);
        Ok(SweepResults {
            done: rows.iter().filter(|row| row.state == DONE).count(),
            first_open: first_open.map(|(variant, _)| variant.folder.clone()),
            table: self.table(&columns, &rows)?,
        })
    }

    fn table(&self, columns: &[String], rows: &[Row]) -> Result<String, SweepError> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let head = [NAME.to_owned()].into_iter().chain(self.parameters.clone());
        writer.write_record(head.chain(["state".to_owned()]).chain(columns.iter().cloned()))?;
        for (variant, row) in self.variants.iter().zip(rows) {
            let value = |all: &[(String, String)], name: &str| {
                all.iter().find(|(n, _)| n == name).map_or_else(String::new, |(_, v)| v.clone())
            };
            let settings = self.parameters.iter().map(|name| value(&variant.settings, name));
            let found = columns.iter().map(|column| value(&row.cells, column));
            let begin = std::iter::once(variant.folder.clone()).chain(settings);
            writer.write_record(begin.chain([row.state.to_owned()]).chain(found))?;
        }
        let bytes = writer.into_inner().map_err(|e| csv::Error::from(e.into_error()))?;
        Ok(String::from_utf8(bytes).expect("cells are text"))
    }
}

/// What the runs of a sweep have left.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SweepResults {
    /// A line for each variant, as CSV with a head.
    pub table: String,
    /// How many variants have run with the values of the table.
    pub done: usize,
    /// The folder of the first that has not.
    pub first_open: Option<String>,
}

const DONE: &str = "done";
const NOT_RUN: &str = "not run";
const OUTDATED: &str = "other values";

/// What the table says of a variant.
struct Row {
    state: &'static str,
    cells: Vec<(String, String)>,
}

impl Row {
    /// What a manifest says, if it is that of the variant.
    fn read(variant: &Variant, text: &str) -> Result<Self, SweepError> {
        let bad =
            |message: String| SweepError::BadManifest { folder: variant.folder.clone(), message };
        let told: Value = serde_json::from_str(text).map_err(|e| bad(e.to_string()))?;
        let Some(Value::Object(parameters)) = told.get("parameters") else {
            return Err(bad("it names no parameters".to_owned()));
        };
        let is_same = |(name, value): &(String, String)| {
            parameters.get(name).and_then(Value::as_str) == Some(value.as_str())
        };
        let settings = &variant.settings;
        if settings.len() != parameters.len() || !settings.iter().all(is_same) {
            return Ok(Self { state: OUTDATED, cells: Vec::new() });
        }
        let mut cells = Vec::new();
        for part in RESULTS {
            told.get(*part).into_iter().for_each(|value| flatten(part, value, &mut cells));
        }
        Ok(Self { state: DONE, cells })
    }
}

/// What of a manifest goes into the table of results, in this order.
const RESULTS: &[&str] = &["verdict", "model", "panels", "fabrication"];

/// A line of the table; its folder is empty without a column for it.
fn variant(columns: &[String], record: &csv::StringRecord) -> Variant {
    let mut variant = Variant { folder: String::new(), settings: Vec::new() };
    for (column, cell) in columns.iter().zip(record) {
        if column == NAME {
            cell.clone_into(&mut variant.folder);
        } else if !cell.is_empty() {
            variant.settings.push((column.clone(), cell.to_owned()));
        }
    }
    variant
}

/// Every variant has a folder that no other has, also where the case of letters does not count.
fn check_names(variants: &[Variant], lines: &[u64]) -> Result<(), SweepError> {
    let mut seen = HashSet::new();
    for (variant, &line) in variants.iter().zip(lines) {
        let name = &variant.folder;
        let plain = |c: char| c.is_alphanumeric() || "-_.+ ".contains(c);
        let advice = if name.is_empty() || name.starts_with('.') || !name.chars().all(plain) {
            "use letters, digits, and - _ + or . inside"
        } else if !seen.insert(name.to_lowercase()) {
            "another line has it"
        } else {
            continue;
        };
        return Err(SweepError::BadName { line, name: name.clone(), advice });
    }
    Ok(())
}

/// The numbers and words in a value, named by the keys on the way to them; lists are left out.
fn flatten(name: &str, value: &Value, cells: &mut Vec<(String, String)>) {
    match value {
        Value::Object(parts) => {
            parts.iter().for_each(|(key, part)| flatten(&format!("{name}.{key}"), part, cells));
        }
        Value::String(text) => cells.push((name.to_owned(), text.clone())),
        Value::Number(_) | Value::Bool(_) => cells.push((name.to_owned(), value.to_string())),
        Value::Array(_) | Value::Null => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::code::Coded;

    const RECIPE: &str = "[parameters]\nsize = \"20mm\"\noffset = 0.2\n[[step]]\nsolid = \
        \"cube\"\nsize = \"{size}\"\n[[step]]\n\
        cut = \"vertex\"\nselect = \"all\"\noffset = \"{offset}\"\n";

    #[test]
    fn every_line_is_a_command_with_a_folder_of_its_own() {
        let sweep = Sweep::parse("size, offset\n10mm,\n\"30 mm\",0.4\n", RECIPE).expect("a sweep");
        assert_eq!(
            sweep.commands("my cube.toml", "out"),
            [
                "kerfold run 'my cube.toml' --set size=10mm --manifest -o out/1",
                "kerfold run 'my cube.toml' --set 'size=30 mm' --set offset=0.4 --manifest -o out/2",
            ]
        );
        let named = Sweep::parse("name,size\nsmall,10mm\nlarge,30mm\n", RECIPE).expect("a sweep");
        assert_eq!(named.parameters, ["size"]);
        assert!(named.commands("c.toml", "o")[1].ends_with("-o o/large"));
    }

    #[test]
    fn tables_that_are_no_sweep_are_refused_with_their_line() {
        for (table, code, part) in [
            ("", "E772", "no variants"),
            ("size\n", "E772", "no variants"),
            ("size,size\n1mm,2mm\n", "E774", "`size`"),
            ("size\n1mm\n2mm,3mm\n", "E771", "line: 3"),
            ("size\n1mm\n2 miles\n", "E776", "line 3"),
            ("sise\n1mm\n", "E776", "did you mean `size`?"),
            ("name,size\na,1mm\nA,2mm\n", "E775", "line 3"),
            ("name,size\n../a,1mm\n", "E775", "line 2"),
            ("name,size\n,1mm\n", "E775", "line 2"),
        ] {
            let error = Sweep::parse(table, RECIPE).expect_err(table);
            assert_eq!(error.code().to_string(), code, "{table}: {error}");
            assert!(error.to_string().contains(part), "{table}: {error}");
        }
    }

    #[test]
    fn results_are_one_table_with_a_line_for_every_variant() {
        let sweep = Sweep::parse("size\n10mm\n30mm\n", RECIPE).expect("a sweep");
        let done = r#"{"parameters": {"size": "30mm"}, "verdict": "pass",
            "model": {"faces": 6, "size_mm": [1, 2, 3]}}"#;
        let done = || Some(done.to_owned());
        let found = sweep.results(&[None, done()]).expect("manifests");
        assert_eq!(
            found.table,
            "name,size,state,verdict,model.faces\n1,10mm,not run,,\n2,30mm,done,pass,6\n"
        );
        assert_eq!((found.done, found.first_open.as_deref()), (1, Some("1")));
        // What ran with another value of the table is no result of this one.
        let found = sweep.results(&[done(), done()]).expect("manifests");
        assert!(found.table.contains("1,10mm,other values,,\n"), "{}", found.table);
        assert_eq!((found.done, found.first_open.as_deref()), (1, Some("1")));
        let error = sweep.results(&[Some("{".to_owned()), None]).expect_err("no JSON");
        assert_eq!(error.code().to_string(), "E777");
    }
}
