//! The schedule of panels as a workbook: `schedule.xlsx`, written through `rust_xlsxwriter`.
//!
//! The tables are those of the CSV files, a sheet for each: panels, edges, nodes, cutting list. Single
//! numbers are numbers, everything else is text, so that nothing is taken for a formula or a date.
//! The workbook has no dates and is the same for the same input.

use rust_xlsxwriter::{DocProperties, ExcelDateTime, Format, Workbook, XlsxError};

use super::IoError;
use super::panels_csv::{Table, cutting_list_table, edges_table, nodes_table, panels_table};
use crate::panel::{Plates, Schedule};
use crate::sheet::Layout;

/// Longest text that a cell takes.
const LONGEST: usize = 32_767;

/// The bytes of the workbook; `command` is the command line that made it.
///
/// # Errors
/// [`IoError::Workbook`] for what no workbook can hold, like more than a million rows.
///
/// # Example
/// ```
/// use kerfold::io::panels_xlsx::panels_xlsx;
/// use kerfold::panel::{PanelParams, panel_net, plates, schedule};
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(200.0);
/// let params = PanelParams::default();
/// let made = plates(&cube, Length::from_mm(5.0), &params, &Silent)?;
/// let list = schedule(&cube, &made, &params, &Silent)?;
/// let sheets = lay_out(&panel_net(&cube, &made, 1.0, &[]), &SheetParams::default())?;
/// assert!(panels_xlsx(&list, &made, &sheets.layout, "my program")?.starts_with(b"PK"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn panels_xlsx(
    schedule: &Schedule,
    plates: &Plates,
    layout: &Layout,
    command: &str,
) -> Result<Vec<u8>, IoError> {
    let tables = [
        ("Panels", panels_table(schedule, plates, layout)),
        ("Edges", edges_table(schedule)),
        ("Nodes", nodes_table(schedule)),
        ("Cutting list", cutting_list_table(schedule)),
    ];
    workbook(&tables, command).map_err(|fault| IoError::Workbook { fault: fault.to_string() })
}

fn workbook(tables: &[(&str, Table)], command: &str) -> Result<Vec<u8>, XlsxError> {
    let mut book = Workbook::new();
    // A date that never changes: the first that the format knows.
    let never = ExcelDateTime::from_ymd(1900, 1, 1)?;
    let about = DocProperties::new().set_comment(command).set_author("kerfold");
    book.set_properties(&about.set_creation_datetime(&never));
    let bold = Format::new().set_bold().set_text_wrap();
    for (name, table) in tables {
        let sheet = book.add_worksheet();
        sheet.set_name(*name)?;
        sheet.set_freeze_panes(1, 1)?;
        for (column, title) in (0..).zip(&table.columns) {
            sheet.write_string_with_format(0, column, *title, &bold)?;
            sheet.set_column_width(column, (title.len() as f64).clamp(8.0, 18.0))?;
        }
        for (row, fields) in (1..).zip(&table.rows) {
            for (column, field) in (0..).zip(fields) {
                match number(field) {
                    Some(value) => sheet.write_number(row, column, value)?,
                    None => sheet.write_string(row, column, shortened(field))?,
                };
            }
        }
        if !table.rows.is_empty() {
            let last = (table.rows.len() as u32, table.columns.len() as u16 - 1);
            sheet.autofilter(0, 0, last.0, last.1)?;
        }
    }
    book.save_to_buffer()
}

/// A field that is one plain number.
fn number(field: &str) -> Option<f64> {
    let is_plain = field.bytes().all(|b| b.is_ascii_digit() || b"+-.e".contains(&b));
    field.parse().ok().filter(|value: &f64| is_plain && value.is_finite())
}

/// What a cell can hold of a text; the CSV has all of it.
fn shortened(field: &str) -> String {
    if field.chars().count() <= LONGEST {
        return field.to_owned();
    }
    field.chars().take(LONGEST - 1).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_single_numbers_are_numbers() {
        assert_eq!(["12", "-0.5", "1.2e-9"].map(number), [Some(12.0), Some(-0.5), Some(1.2e-9)]);
        for text in ["", "1 2", "=1+1", "P01", "inf", "nan", "1/2"] {
            assert_eq!(number(text), None, "{text}");
        }
    }

    #[test]
    fn the_same_tables_give_the_same_bytes() {
        let table = || Table {
            columns: vec!["a", "b"],
            rows: vec![vec!["1".to_owned(), "=HYPERLINK()".to_owned()]],
        };
        let book = || workbook(&[("One", table())], "kerfold").expect("a workbook");
        assert_eq!(book(), book());
        assert!(shortened(&"x".repeat(40_000)).chars().count() == LONGEST);
    }
}
