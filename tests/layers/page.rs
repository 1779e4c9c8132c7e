//! The tables of `docs/architecture.md` are those of this test: who changes one changes both.

use super::source::{read, root};
use super::{DOORS, KERNEL, ROOMS, SHEET};

/// The rows of the table under a heading of the page, without its head.
fn rows<'a>(page: &'a str, heading: &str) -> Vec<&'a str> {
    let section = page.lines().skip_while(|line| *line != heading).skip(1);
    section
        .take_while(|line| !line.starts_with("## "))
        .filter(|l| l.starts_with('|'))
        .skip(2)
        .collect()
}

/// A row of the layers as the page shows it.
fn layer_row(room: &super::Room) -> String {
    let home = match room.home {
        KERNEL => "kernel",
        SHEET => "sheet",
        _ => "kerfold",
    };
    let may_use = if room.may_use.is_empty() { "–".to_owned() } else { room.may_use.join(", ") };
    format!("| {} | {home} | `{}` | {may_use} |", room.layer, room.module)
}

/// The beginning of a row of the doors; what the crate is for is free text.
fn door_row((name, places): &(&str, &[&str])) -> String {
    let places: Vec<String> = places.iter().map(|place| format!("`{place}`")).collect();
    format!("| {name} | {} | ", places.join(", "))
}

#[test]
fn the_page_shows_the_tables_of_this_test() {
    let page = read(&root().join("docs/architecture.md"));
    let layers: Vec<String> = ROOMS.iter().map(layer_row).collect();
    assert_eq!(rows(&page, "## Layers"), layers, "docs/architecture.md, Layers");
    let doors = rows(&page, "## Doors");
    assert_eq!(doors.len(), DOORS.len(), "docs/architecture.md, Doors: as many rows as DOORS");
    for (row, door) in doors.iter().zip(DOORS) {
        let wanted = door_row(door);
        let says_why = row.len() > wanted.len() + "|".len();
        assert!(row.starts_with(&wanted) && says_why, "docs/architecture.md, Doors: {wanted}… |");
    }
}

#[test]
fn every_dependency_has_a_reason() {
    let page = read(&root().join("docs/dependencies.md"));
    let rows = rows(&page, "## What we take");
    let listed: Vec<String> = rows
        .iter()
        .filter_map(|row| row.split('|').nth(1))
        .map(|name| name.trim().replace('-', "_"))
        .collect();
    let doors: Vec<&str> = DOORS.iter().map(|(name, _)| *name).collect();
    assert_eq!(listed, doors, "docs/dependencies.md, What we take: one row for each of DOORS");
}
