//! The planarity of every face as a table: CSV as of RFC 4180.

use std::collections::HashSet;
use std::fmt::Write;

use crate::check::{Element, Report};
use crate::io::csv_cell::cell;

/// One row per face: `face,sides,mm,permille,degrees,percent,verdict,command`. `percent` is empty
/// for faces without four sides; the verdict is `fail` for a face with any finding. The command
/// line stands in the first row only. Numbers have a point and read back to the same bits; lines
/// end with CR LF.
///
/// # Example
/// ```
/// use kerfold::io::report::csv::check_csv;
/// use kerfold::prelude::*;
///
/// let report = check(&kerfold::shape::cube(40.0), &CheckParams::default())?;
/// let csv = check_csv(&report, "my program");
/// assert_eq!(csv.lines().filter(|line| !line.starts_with('#')).count(), 1 + 6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_csv(report: &Report, command: &str) -> String {
    let failed: HashSet<usize> =
        report.findings.iter().filter(|f| f.element == Element::Face).map(|f| f.id).collect();
    let mut out = String::from("face,sides,mm,permille,degrees,percent,verdict,command\r\n");
    let mut command = cell(command);
    for f in &report.faces {
        let p = &f.planarity;
        let percent = p.percent.map(|p| format!("{p:?}")).unwrap_or_default();
        let verdict = if failed.contains(&f.face.index()) { "fail" } else { "pass" };
        let command = std::mem::take(&mut command);
        write!(
            out,
            "{},{},{:?},{:?},{:?},{percent},{verdict},{command}\r\n",
            f.face, f.sides, p.mm, p.permille, p.degrees
        )
        .expect("writing to a string cannot fail");
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::{CheckParams, check};
    use crate::fixtures::{cube, cube_corners, ell_prism};
    use crate::mesh::{Mesh, VertexId};
    use glam::DVec3;

    #[test]
    fn a_row_for_each_face_with_its_verdict() {
        let mut mesh = cube();
        mesh.set_position(VertexId::new(0), DVec3::new(-1.0, -1.0, -2.0), true);
        let report = check(&mesh, &CheckParams::default()).expect("good limits");
        let csv = check_csv(&report, "kerfold check \"a, b.obj\"");
        let rows: Vec<Vec<&str>> =
            csv.split_terminator("\r\n").map(|row| row.splitn(8, ',').collect()).collect();
        assert_eq!(rows.len(), 7);
        assert_eq!(rows[0].join(","), "face,sides,mm,permille,degrees,percent,verdict,command");
        assert_eq!(rows[1][7], "\"kerfold check \"\"a, b.obj\"\"\"");
        assert!(rows[1..].iter().all(|row| row.len() == 8 && row[1] == "4"));
        assert_eq!(
            rows[1..].iter().map(|row| row[6]).collect::<Vec<_>>(),
            ["fail", "pass", "pass", "pass", "pass", "pass"]
        );
        assert!(rows[2..].iter().all(|row| row[7].is_empty()));
        assert_eq!(rows[1][2].parse(), Ok(report.faces[0].planarity.mm));
    }

    #[test]
    fn only_quads_have_a_percentage() {
        let ell = check(&ell_prism(), &CheckParams::default()).expect("good limits");
        let csv = check_csv(&ell, "kerfold");
        assert!(
            csv.lines()
                .nth(1)
                .is_some_and(|row| row.starts_with("0,6,") && row.ends_with(",,pass,kerfold"))
        );
        let triangle =
            Mesh::from_faces(cube_corners().into_iter().take(3), [[0, 1, 2]]).expect("a triangle");
        let report = check(&triangle, &CheckParams::default()).expect("good limits");
        assert_eq!(check_csv(&report, "k").lines().nth(1), Some("0,3,0.0,0.0,0.0,,pass,k"));
    }
}
