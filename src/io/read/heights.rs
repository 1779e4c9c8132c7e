//! Heights over a grid, as CSV: a table whose first row is x and first column y, or rows x,y,z.

use glam::DVec3;

use super::ReadNote;
use super::raw::RawMesh;
use super::text::{Commas, Lines, number, words};
use crate::io::error::{ContentFault, Located, excerpt};

/// More places are refused before a mesh is made of them; it would have twice as many triangles.
const MOST_PLACES: usize = 1_500_000;
/// Values of x that differ by less than this part of their range are one.
const SAME: f64 = 1e-6;

/// The heights of a file, sorted.
struct Heights {
    x: Vec<f64>,
    y: Vec<f64>,
    /// Row after row, x running.
    z: Vec<f64>,
    /// The line of each.
    lines: Vec<u32>,
    is_list: bool,
}

pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, Located> {
    if bytes.contains(&0) {
        return Err(Located::anywhere(ContentFault::NotText { format: "CSV" }));
    }
    let mut table = Table::new(bytes);
    let heights = if table.is_list()? { list(&mut table)? } else { grid(&mut table)? };
    let mut raw = mesh_of(&heights);
    let (columns, rows) = (heights.x.len(), heights.y.len());
    raw.notes.push(ReadNote::Heights { columns, rows, is_list: heights.is_list });
    raw.notes.extend(table.commas.note());
    Ok(raw)
}

/// Lines of cells with one separator throughout.
struct Table<'a> {
    lines: Lines<'a>,
    /// `None` for white space.
    separator: Option<u8>,
    commas: Commas,
}

type Row<'a> = (usize, Vec<&'a [u8]>);

impl<'a> Table<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        let lines = Lines::new(bytes);
        let (_, first) = lines.clone().next_content().unwrap_or_default();
        let separator = [b';', b'\t', b','].into_iter().find(|s| first.contains(s));
        Self { lines, separator, commas: Commas::default() }
    }

    fn next(&mut self) -> Option<Row<'a>> {
        // A tab at the start of a line is an empty cell, not white space.
        let (line, text) = match self.separator {
            Some(b'\t') => self
                .lines
                .by_ref()
                .map(|(line, text)| (line, super::text::without_comment(text)))
                .find(|(_, text)| !text.trim_ascii().is_empty())?,
            _ => self.lines.next_content()?,
        };
        let cells = match self.separator {
            Some(separator) => text.split(|&b| b == separator).map(unquoted).collect(),
            None => words(text).collect(),
        };
        Some((line, cells))
    }

    /// A finite number in a cell, by its place in the line from 0.
    fn number(&mut self, (line, cells): &Row, column: usize) -> Result<f64, Located> {
        let cell = cells.get(column).copied().unwrap_or_default();
        let value = match self.separator {
            Some(b',') => number(cell),
            _ => self.commas.number(cell, *line),
        };
        value.filter(|v| v.is_finite()).ok_or_else(|| {
            let what = format!("column {} is `{}`, not a number", column + 1, excerpt(cell));
            broken(Some(*line), what)
        })
    }

    /// Whether the file has rows x, y, z; their names, if there, are passed over.
    fn is_list(&mut self) -> Result<bool, Located> {
        let start = self.lines.clone();
        let Some((line, cells)) = self.next() else {
            return Err(broken(None, "there are no heights".to_owned()));
        };
        let is_number = |cell: &&[u8]| super::text::decimal(cell).is_some();
        let numbers = cells.iter().filter(|cell| is_number(cell)).count();
        if cells.len() < 3 {
            let found = format!("the first line has {} cells", cells.len());
            return Err(broken(Some(line), format!("{found}, but three are the least")));
        }
        if cells.len() == 3 && numbers == 0 {
            let begins = |(cell, letter): (&&[u8], u8)| {
                cell.first().is_some_and(|c| c.eq_ignore_ascii_case(&letter))
            };
            if cells.iter().zip(*b"xyz").all(begins) {
                return Ok(true);
            }
            let what = "the names of three columns must be x, y and z, in this order";
            return Err(broken(Some(line), what.to_owned()));
        }
        self.lines = start;
        Ok(cells.len() == 3 && numbers == 3)
    }
}

/// A cell without white space and quotes around it.
fn unquoted(cell: &[u8]) -> &[u8] {
    let cell = cell.trim_ascii();
    let inner = cell.strip_prefix(b"\"").and_then(|c| c.strip_suffix(b"\""));
    inner.unwrap_or(cell)
}

fn broken(line: Option<usize>, what: String) -> Located {
    Located { line, fault: ContentFault::BrokenGrid { what } }
}

fn too_many(line: usize) -> Located {
    broken(Some(line), format!("there are more than {MOST_PLACES} heights; thin them out"))
}

/// A table: the first row is x, the first column y.
fn grid(table: &mut Table) -> Result<Heights, Located> {
    let head = table.next().unwrap_or_default();
    let columns = head.1.len() - 1;
    let mut x = Vec::with_capacity(columns);
    for column in 1..=columns {
        x.push(table.number(&head, column)?);
        if !goes_on(&x) {
            let what = format!(
                "the first row is x, but column {} of it, {}, does not go on from {}; x must rise \
                throughout or fall throughout",
                column + 1,
                x[column - 1],
                x[column - 2]
            );
            return Err(broken(Some(head.0), what));
        }
    }
    let (mut y, mut z, mut lines) = (Vec::new(), Vec::new(), Vec::new());
    while let Some(row) = table.next() {
        if row.1.len() != columns + 1 {
            let what = format!(
                "{} cells stand in this line, but the first line has {}; every row needs a y and a \
                height for each x",
                row.1.len(),
                columns + 1
            );
            return Err(broken(Some(row.0), what));
        }
        if z.len() + columns > MOST_PLACES {
            return Err(too_many(row.0));
        }
        y.push(table.number(&row, 0)?);
        if !goes_on(&y) {
            let (here, before) = (y[y.len() - 1], y[y.len() - 2]);
            let what = format!(
                "the first column is y, but {here} does not go on from {before}; y must rise \
                throughout or fall throughout"
            );
            return Err(broken(Some(row.0), what));
        }
        for column in 1..=columns {
            z.push(table.number(&row, column)?);
            lines.push(row.0 as u32);
        }
    }
    if y.len() < 2 {
        return Err(broken(None, format!("there are {} rows of heights, not two", y.len())));
    }
    Ok(sorted(Heights { x, y, z, lines, is_list: false }))
}

/// Whether the last value goes on in the direction of the first two.
fn goes_on(values: &[f64]) -> bool {
    match *values {
        [first, second, .., before, last] => (last - before) * (second - first).signum() > 0.0,
        [first, second] => first != second,
        [first, second, last] => (last - second) * (second - first).signum() > 0.0,
        _ => true,
    }
}

/// The same heights with x and y rising.
fn sorted(mut heights: Heights) -> Heights {
    let width = heights.x.len();
    if heights.x[0] > heights.x[1] {
        heights.x.reverse();
        heights.z.chunks_mut(width).for_each(<[f64]>::reverse);
    }
    if heights.y[0] > heights.y[1] {
        heights.y.reverse();
        heights.z = heights.z.chunks(width).rev().flatten().copied().collect();
        heights.lines = heights.lines.chunks(width).rev().flatten().copied().collect();
    }
    heights
}

/// Rows x, y, z in any order.
fn list(table: &mut Table) -> Result<Heights, Located> {
    let (mut points, mut lines) = (Vec::new(), Vec::new());
    while let Some(row) = table.next() {
        if row.1.len() != 3 {
            let what = format!("{} cells stand in this line, not x, y and z", row.1.len());
            return Err(broken(Some(row.0), what));
        }
        if points.len() >= MOST_PLACES {
            return Err(too_many(row.0));
        }
        let mut cell = |column| table.number(&row, column);
        points.push([cell(0)?, cell(1)?, cell(2)?]);
        lines.push(row.0 as u32);
    }
    let x = distinct(points.iter().map(|p| p[0]));
    let y = distinct(points.iter().map(|p| p[1]));
    if x.len() < 2 || y.len() < 2 {
        let what = format!("there are {} values of x and {} of y, not two", x.len(), y.len());
        return Err(broken(None, what));
    }
    let column = |p: &[f64; 3]| nearest(&x, p[0]);
    let row = |p: &[f64; 3]| nearest(&y, p[1]);
    off_grid(&points, &lines, [x.len(), y.len()], [&column, &row])?;
    let mut order: Vec<Option<usize>> = vec![None; points.len()];
    for (i, p) in points.iter().enumerate() {
        if let Some(earlier) = order[row(p) * x.len() + column(p)].replace(i) {
            let what =
                format!("x = {}, y = {} stood in line {} already", p[0], p[1], lines[earlier]);
            return Err(broken(Some(lines[i] as usize), what));
        }
    }
    // As many as there are places and none twice, so all are taken.
    let order: Vec<usize> = order.into_iter().flatten().collect();
    let z = order.iter().map(|&i| points[i][2]).collect();
    let lines = order.iter().map(|&i| lines[i]).collect();
    Ok(Heights { x, y, z, lines, is_list: true })
}

type PlaceOf<'a> = &'a dyn Fn(&[f64; 3]) -> usize;

/// Refuses points that are not as many as the places of their grid.
fn off_grid(
    points: &[[f64; 3]],
    lines: &[u32],
    [columns, rows]: [usize; 2],
    [column, row]: [PlaceOf<'_>; 2],
) -> Result<(), Located> {
    if points.len() == columns.saturating_mul(rows) {
        return Ok(());
    }
    let (mut in_column, mut in_row) = (vec![0_usize; columns], vec![0_usize; rows]);
    for p in points {
        in_column[column(p)] += 1;
        in_row[row(p)] += 1;
    }
    let odd = points.iter().position(|p| in_column[column(p)] != rows || in_row[row(p)] != columns);
    let at = odd.map(|i| {
        let [x, y, _] = points[i];
        let (shared_x, shared_y) = (in_column[column(&points[i])], in_row[row(&points[i])]);
        format!(
            "; x = {x} comes {shared_x} times where y has {rows} values, y = {y} {shared_y} times \
            where x has {columns}"
        )
    });
    let what = format!(
        "{} points with {columns} values of x and {rows} of y are no whole grid{}",
        points.len(),
        at.unwrap_or_default()
    );
    Err(broken(odd.map(|i| lines[i] as usize), what))
}

/// The values that differ, rising.
fn distinct(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut all: Vec<f64> = values.collect();
    all.sort_by(f64::total_cmp);
    let range = all.last().zip(all.first()).map_or(0.0, |(last, first)| last - first);
    all.dedup_by(|b, a| *b - *a <= SAME * range);
    all
}

/// The place of the value that is nearest.
fn nearest(values: &[f64], value: f64) -> usize {
    let after = values.partition_point(|&v| v < value).min(values.len() - 1);
    let before = after.saturating_sub(1);
    if value - values[before] < values[after] - value { before } else { after }
}

/// Two triangles for each cell, divided by the shorter diagonal, in turns where both are equal.
fn mesh_of(heights: &Heights) -> RawMesh {
    let Heights { x, y, z, lines, .. } = heights;
    let width = x.len();
    let place = |i: usize| DVec3::new(x[i % width], y[i / width], z[i]);
    let mut raw = RawMesh {
        positions: (0..z.len()).map(place).collect(),
        vertex_lines: lines.clone(),
        ..RawMesh::default()
    };
    for row in 0..y.len() - 1 {
        for column in 0..width - 1 {
            let a = row * width + column;
            let [a, b, c, d] = [a, a + 1, a + width + 1, a + width];
            let length = |i: usize, j: usize| place(i).distance_squared(place(j));
            let (main, other) = (length(a, c), length(b, d));
            let along_main = main < other || main == other && (row + column) % 2 == 0;
            let pair = if along_main { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
            pair.into_iter().for_each(|t| raw.push_face(t.map(|i| i as u32)));
            raw.face_lines.extend([lines[a], lines[a]]);
        }
    }
    raw
}

#[cfg(test)]
mod tests {
    use super::*;

    fn positions(text: &str) -> Vec<DVec3> {
        read(text.as_bytes()).expect(text).positions
    }

    #[test]
    fn a_table_and_a_list_are_the_same_heights() {
        let wanted: Vec<DVec3> = [0.0, 1.0, 3.0]
            .into_iter()
            .flat_map(|y| [0.0, 2.0].map(|x| DVec3::new(x, y, x + 10.0 * y)))
            .collect();
        for text in [
            "y\\x,0,2\n0,0,2\n1,10,12\n3,30,32\n",
            "x,y,z\n2,0,2\n0,0,0\n0,1,10\n2,1,12\n0,3,30\n2,3,32\n",
            "# heights\n\t2\t0\n3\t32\t30\n1\t12\t10\n0\t2\t0\n",
            "\"X\";\"Y\";\"Z\"\n2,0;0;2\n0;0;0\n0;1;10\n2;1;12\n0;3;30\n2;3;32",
            "0 0 0\r\n2 0 2\r\n0 1 10\r\n2 1 12\r\n0 3 30\r\n2 3.0000000001 32\r\n",
        ] {
            let found = positions(text);
            let off = found.iter().zip(&wanted).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            assert!(found.len() == 6 && off < 1e-9, "{text}: {found:?}");
        }
    }

    #[test]
    fn cells_are_divided_by_the_shorter_diagonal_and_look_up() {
        let raw = read(b",0,1,2\n0,0,0,0\n1,0,5,0\n2,0,0,0\n").expect("a peak");
        assert_eq!(raw.ends.len(), 8);
        // Every diagonal avoids the peak, vertex 4, where the other is shorter.
        for t in raw.corners.chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|i| raw.positions[t[i] as usize]);
            assert!((b - a).cross(c - a).z > 0.0, "{t:?}");
        }
        assert_eq!(raw.corners.iter().filter(|&&v| v == 4).count(), 4);
    }

    #[test]
    fn what_is_no_grid_is_told_with_line_and_column() {
        for (text, line, told) in [
            ("1,2\n", Some(1), "three are the least"),
            ("x,y,height\n1,2,3\n", Some(1), "x, y and z"),
            (",0,1,1\n0,1,2,3\n", Some(1), "column 4"),
            (",0,1,2\n0,1,2,3\n1,1,2\n", Some(3), "3 cells"),
            (",0,1,2\n0,1,2,3\n1,1,no,3\n", Some(3), "column 3"),
            (",0,1,2\n0,1,2,3\n1,1,,3\n", Some(3), "column 3"),
            (",0,1,2\n0,1,2,3\n1,1,inf,3\n", Some(3), "column 3"),
            (",0,1,2\n0,1,2,3\n1,1,2,3\n0.5,1,2,3\n", Some(4), "does not go on from 1"),
            (",0,1,2\n0,1,2,3\n", None, "1 rows"),
            ("0,0,1\n1,0,1\n0,1,1\n1,1\n", Some(4), "2 cells"),
            ("0,0,1\n1,0,1\n0,1,1\n2,1,4\n", Some(1), "no whole grid"),
            ("0,0,1\n1,0,1\n0,1,1\n0,1,4\n", Some(4), "line 3"),
            ("0,0,1\n0,1,1\n0,2,1\n", None, "1 values of x"),
        ] {
            let fault = read(text.as_bytes()).expect_err(text);
            let said = fault.fault.to_string();
            assert!(fault.line == line && said.contains(told), "{text}: {fault:?}");
        }
        let long = format!(",{}\n", (0..1000).map(|i| i.to_string()).collect::<Vec<_>>().join(","));
        let row = |y: usize| format!("{y}{}\n", ",0".repeat(1000));
        let text = long + &(0..1600).map(row).collect::<String>();
        let fault = read(text.as_bytes()).expect_err("too many");
        assert_eq!(fault.line, Some(1502));
        let scattered: String =
            (0..3000).map(|i| format!("{i},{},0\n", (i * 7919) % 3001)).collect();
        assert!(read(scattered.as_bytes()).is_err());
    }
}
