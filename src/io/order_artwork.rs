//! Outlines of a drawing as pieces to be nested: what lies in no other outline is a piece, what lies
//! in one of them is a hole of it, what lies in a hole is a piece again.

use std::fmt::Write as _;

use glam::DVec2;

use super::artwork::FLATNESS;
use crate::geom::polygon::{Location, locate, signed_area};
use crate::lint::{ArtPath, Artwork};

/// Ends of lines that are at most so far apart belong together, in mm: what `lint` takes for one.
pub const GAP: f64 = 2.5 * FLATNESS;

/// The pieces of a drawing as the JSON that `nest` reads. Only lines that are cut count; open ones
/// are joined where their ends meet.
///
/// # Errors
/// What is wrong in words: no closed outline, or lines that stay open.
///
/// # Example
/// ```
/// use kerfold::io::artwork::read_artwork;
/// use kerfold::io::order_artwork::pieces_of_artwork;
/// use std::path::Path;
///
/// let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" width="50mm" height="30mm"
///     viewBox="0 0 50 30"><rect x="5" y="5" width="40" height="20"/>
///     <circle cx="20" cy="15" r="3"/></svg>"#;
/// let (_, pages) = read_artwork(Path::new("lid.svg"), svg.as_bytes())?;
/// let pieces = pieces_of_artwork(&pages)?;
/// let count = |key| pieces.matches(key).count();
/// assert_eq!((count("\"outline\":"), count("\"holes\":")), (1, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn pieces_of_artwork(pages: &[Artwork]) -> Result<String, String> {
    let mut pieces = Vec::new();
    for (number, page) in pages.iter().enumerate() {
        let contours = contours(page)?;
        let depth = |i: usize| -> usize {
            let others = contours.iter().enumerate();
            others.filter(|&(j, other)| j != i && is_inside(&contours[i], other)).count()
        };
        let depths: Vec<usize> = (0..contours.len()).map(depth).collect();
        for (i, outline) in
            contours.iter().enumerate().filter(|&(i, _)| depths[i].is_multiple_of(2))
        {
            let is_hole =
                |&j: &usize| depths[j] == depths[i] + 1 && is_inside(&contours[j], outline);
            let holes: Vec<String> =
                (0..contours.len()).filter(is_hole).map(|j| points(&contours[j].points)).collect();
            let name = outline.name.clone();
            let name = name.unwrap_or_else(|| format!("page {}, outline {}", number + 1, i + 1));
            let mut piece = String::new();
            let _ = write!(
                piece,
                "{{\"id\": {}, \"outline\": {}, \"holes\": [{}]}}",
                serde_json::Value::from(name),
                points(&outline.points),
                holes.join(", ")
            );
            pieces.push(piece);
        }
    }
    if pieces.is_empty() {
        return Err("the drawing has no closed outline that is cut; `kerfold lint` tells what it \
            holds"
            .to_owned());
    }
    Ok(format!("{{\"units\": \"mm\", \"pieces\": [\n{}\n]}}", pieces.join(",\n")))
}

/// A closed line that is cut.
struct Contour {
    points: Vec<DVec2>,
    name: Option<String>,
    area: f64,
}

fn contours(page: &Artwork) -> Result<Vec<Contour>, String> {
    let cuts = || page.paths.iter().filter(|path| path.operation.is_cut());
    let closed = |path: &&ArtPath| path.closed;
    let mut found: Vec<Contour> =
        cuts().filter(closed).filter_map(|p| contour(p.points.clone(), p.name.clone())).collect();
    let mut open: Vec<Vec<DVec2>> =
        cuts().filter(|p| !p.closed && p.points.len() > 1).map(|p| p.points.clone()).collect();
    while let Some(mut chain) = open.pop() {
        while !do_meet(chain[0], chain[chain.len() - 1]) {
            let end = chain[chain.len() - 1];
            let next = open
                .iter()
                .position(|line| do_meet(line[0], end) || do_meet(line[line.len() - 1], end));
            let Some(next) = next else {
                return Err(format!(
                    "a line that is cut ends at {:.2}, {:.2} and bounds no piece; `kerfold lint` \
                    shows all such ends",
                    end.x, end.y
                ));
            };
            let mut line = open.swap_remove(next);
            if !do_meet(line[0], end) {
                line.reverse();
            }
            chain.extend(line.into_iter().skip(1));
        }
        chain.pop();
        found.extend(contour(chain, None));
    }
    Ok(found)
}

/// `None` for what bounds no area.
fn contour(mut points: Vec<DVec2>, name: Option<String>) -> Option<Contour> {
    points.dedup();
    while points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    let area = signed_area(&points).abs();
    (points.len() > 2 && area > GAP * GAP).then_some(Contour { points, name, area })
}

fn do_meet(a: DVec2, b: DVec2) -> bool {
    a.distance(b) <= GAP
}

/// Whether a contour lies in a larger one: by its corners that are not on the other's border.
fn is_inside(inner: &Contour, outer: &Contour) -> bool {
    let place = |p: &DVec2| locate(&outer.points, *p);
    let decided = inner.points.iter().map(place).find(|place| *place != Location::Boundary);
    inner.area < outer.area && decided == Some(Location::Inside)
}

fn points(points: &[DVec2]) -> String {
    let each: Vec<String> = points.iter().map(|p| format!("[{}, {}]", p.x, p.y)).collect();
    format!("[{}]", each.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::artwork::read_artwork;
    use std::path::Path;

    fn pieces(body: &str) -> Result<serde_json::Value, String> {
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"200mm\" height=\"100mm\" \
            viewBox=\"0 0 200 100\">{body}</svg>"
        );
        let (_, pages) = read_artwork(Path::new("x.svg"), svg.as_bytes()).expect("an SVG");
        pieces_of_artwork(&pages).map(|text| serde_json::from_str(&text).expect("JSON"))
    }

    #[test]
    fn holes_belong_to_their_outline_and_islands_are_pieces() {
        let found = pieces(
            "<rect id=\"plate\" x=\"0\" y=\"0\" width=\"90\" height=\"90\"/>\
            <circle cx=\"45\" cy=\"45\" r=\"30\"/><rect x=\"40\" y=\"40\" width=\"9\" height=\"9\"/>\
            <rect x=\"100\" y=\"0\" width=\"20\" height=\"20\"/>",
        )
        .expect("pieces");
        let list = found["pieces"].as_array().expect("a list");
        let holes: Vec<usize> =
            list.iter().map(|p| p["holes"].as_array().map_or(0, Vec::len)).collect();
        assert_eq!(holes, [1, 0, 0]);
    }

    #[test]
    fn lines_are_joined_and_loose_ends_are_told() {
        let square = "<path d=\"M0 0L10 0\"/><path d=\"M10 10L10 0\"/><path d=\"M0 10L10 10\"/>";
        let stroked =
            |body: &str| pieces(&format!("<g fill=\"none\" stroke=\"#FF0000\">{body}</g>"));
        let closed = stroked(&format!("{square}<path d=\"M0 10L0 0\"/>")).expect("a piece");
        assert_eq!(closed["pieces"][0]["outline"].as_array().map(Vec::len), Some(4));
        let loose = stroked(square).expect_err("an open line");
        assert!(loose.contains("bounds no piece"), "{loose}");
        assert!(pieces("").expect_err("nothing").contains("no closed outline"));
    }
}
