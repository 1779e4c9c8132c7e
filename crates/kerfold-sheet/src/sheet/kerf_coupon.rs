//! A coupon that shows the kerf of a material on a machine, and the slot that holds it.
//!
//! Above, a bar of ten blocks cut apart by single lines in a window: pushed to one side they leave
//! a gap of eleven kerfs (eleven cuts lie side by side). Below, a comb with slots around the
//! thickness, drawn without compensation: the kerf is the thickness less the drawn width of the
//! slot that holds the material tight, so the two ways check one another. How to read both is
//! engraved beside them. What is thinner than 0.3 mm holds in no slot: paper gets a bar of twenty
//! narrow strips alone.

use glam::DVec2;

use super::drawing::{Drawing, MarkKind, Stroke};
use super::error::SheetError;
use super::info::{lettered, moved};
use super::layout::{Sheet, SheetId};
use super::letter::{lettering, plain_lettering};

/// Free border of the coupon, in mm.
const BORDER: f64 = 5.0;

/// Blocks of the bar, their width and height, in mm.
const BLOCKS: (usize, f64, f64) = (10, 10.0, 20.0);

/// The same for paper, whose kerf is narrow: more cuts side by side.
const STRIPS: (usize, f64, f64) = (20, 5.0, 20.0);

/// Material thinner than this is held by no slot, in mm.
const PAPER: f64 = 0.3;

/// Least and largest thickness, in mm.
const THICKNESS: [f64; 2] = [0.01, 100.0];

/// Height of the words that explain, and from one line to the next, in mm.
const WORDS: [f64; 2] = [2.0, 4.0];

/// Slots of the comb, how much each is wider than the one before, and their depth, in mm.
const SLOTS: (usize, f64, f64) = (9, 0.05, 12.0);

/// Width of the teeth between the slots, in mm; two letters of the labels fit.
const TOOTH: f64 = 9.0;

/// Height of lettering, in mm.
const LETTERS: f64 = 2.5;

/// Draws the coupon for a material of the given thickness in mm. `title` is engraved, its letters
/// in capitals; letters without a glyph are left out.
///
/// # Errors
/// [`SheetError::OutOfRange`] for a thickness that is not from 0.01 mm to 100 mm.
///
/// # Example
/// ```
/// let coupon = kerfold_sheet::sheet::kerf_coupon(3.0, "birch 3 mm")?;
/// assert!(coupon.width > 0.0 && coupon.height > 0.0);
/// # Ok::<(), kerfold_sheet::sheet::SheetError>(())
/// ```
pub fn kerf_coupon(thickness: f64, title: &str) -> Result<Drawing, SheetError> {
    let [least, most] = THICKNESS;
    if !(least..=most).contains(&thickness) {
        return Err(SheetError::OutOfRange { name: "thickness", value: thickness, least });
    }
    let has_comb = has_comb(thickness);
    let slots: Vec<f64> = if has_comb { slots(thickness) } else { Vec::new() };
    let comb = match has_comb {
        true => DVec2::new(TOOTH + slots.iter().map(|w| w + TOOTH).sum::<f64>(), SLOTS.2 + 12.0),
        false => DVec2::ZERO,
    };
    let blocks = if has_comb { BLOCKS } else { STRIPS };
    let bar = DVec2::new(blocks.0 as f64 * blocks.1, blocks.2);
    let explained = [how_to_push(thickness), how_to_fit()];
    let lengths = explained.iter().map(|words| Ok(plain_lettering(words, WORDS[0])?.high.x));
    let words = lengths.collect::<Result<Vec<f64>, SheetError>>()?.into_iter().fold(0.0, f64::max);
    // The comb and the words for it, the bar and the words for it, the title.
    let below = if has_comb { comb.y + WORDS[1] + BORDER } else { 0.0 };
    let width = comb.x.max(bar.x).max(words) + 2.0 * BORDER;
    let height = below + bar.y + WORDS[1] + 2.0 * BORDER + 2.0 * LETTERS;
    let sheet =
        Sheet { id: SheetId(0), width: tenths(width), height: tenths(height), ..Sheet::default() };
    let mut drawing = Drawing::new(&sheet);
    if has_comb {
        draw_comb(&mut drawing, DVec2::splat(BORDER), comb, &slots, thickness)?;
        let at = DVec2::new(BORDER, BORDER + comb.y + WORDS[1] - WORDS[0]);
        explain(&mut drawing, "how-to-fit", &explained[1], at)?;
    }
    let low = DVec2::new(BORDER, below + BORDER);
    draw_bar(&mut drawing, low, bar, blocks)?;
    let at = DVec2::new(BORDER, low.y + bar.y + WORDS[1] - WORDS[0]);
    explain(&mut drawing, "how-to-push", &explained[0], at)?;
    let title = lettered(title);
    let words = if title.ends_with(" MM") { title } else { format!("{title}  {thickness} MM") };
    let at = DVec2::new(BORDER, low.y + bar.y + WORDS[1] + LETTERS);
    write(&mut drawing, MarkKind::PieceName, "title", &words, at)?;
    drawing.arrange();
    Ok(drawing)
}

/// Whether a material is thick enough to be held by a slot, so that its coupon has a comb.
pub fn has_comb(thickness: f64) -> bool {
    thickness >= PAPER
}

/// How many cuts lie side by side in the bar of the coupon.
pub fn cuts_of_bar(thickness: f64) -> usize {
    (if has_comb(thickness) { BLOCKS } else { STRIPS }).0 + 1
}

fn how_to_push(thickness: f64) -> String {
    let cuts = cuts_of_bar(thickness);
    format!("1. PUSH ALL TO ONE SIDE: GAP / {cuts} = KERF")
}

fn how_to_fit() -> String {
    "2. TIGHT SLOT: -15 MEANS A KERF OF 0.15 MM".to_owned()
}

fn explain(drawing: &mut Drawing, id: &str, words: &str, at: DVec2) -> Result<(), SheetError> {
    let strokes = moved(plain_lettering(words, WORDS[0])?.strokes, at).collect();
    drawing.add(MarkKind::SeamNumber, id.to_owned(), None, strokes);
    Ok(())
}

/// Widths of the slots, ascending: none above a tenth of a millimetre over the thickness.
fn slots(thickness: f64) -> Vec<f64> {
    let widest = 0.1_f64.min(thickness / 10.0);
    let step = SLOTS.1.min(thickness / 20.0);
    (0..SLOTS.0).map(|i| thickness + widest - step * (SLOTS.0 - 1 - i) as f64).collect()
}

fn draw_comb(
    drawing: &mut Drawing,
    low: DVec2,
    size: DVec2,
    slots: &[f64],
    thickness: f64,
) -> Result<(), SheetError> {
    let top = low.y + size.y;
    let mut points = vec![low, low + DVec2::new(size.x, 0.0), low + size];
    let mut x = low.x + TOOTH;
    let mut notches = Vec::new();
    for (i, width) in slots.iter().enumerate() {
        notches.push([DVec2::new(x, top), DVec2::new(x + width, top)]);
        // Hundredths of a millimetre against the thickness, below the slot.
        let hundredths = ((width - thickness) * 100.0).round();
        let words =
            if hundredths > 0.0 { format!("+{hundredths}") } else { format!("{hundredths}") };
        let text = lettering(&words, LETTERS)?;
        let middle = x + width / 2.0 - (text.low.x + text.high.x) / 2.0;
        let at = DVec2::new(middle, top - SLOTS.2 - 2.0 * LETTERS);
        write(
            drawing,
            MarkKind::SeamNumber,
            &format!("slot-{}", i + 1),
            &words.replace("-0", "0"),
            at,
        )?;
        x += width + TOOTH;
    }
    for [left, right] in notches.into_iter().rev() {
        let down = DVec2::new(0.0, SLOTS.2);
        points.extend([right, right - down, left - down, left]);
    }
    points.push(DVec2::new(low.x, top));
    drawing.add(MarkKind::Outline, "comb".to_owned(), None, vec![Stroke { points, closed: true }]);
    Ok(())
}

fn draw_bar(
    drawing: &mut Drawing,
    low: DVec2,
    size: DVec2,
    blocks: (usize, f64, f64),
) -> Result<(), SheetError> {
    let corners = [(0.0, 0.0), (size.x, 0.0), (size.x, size.y), (0.0, size.y)];
    let points = corners.map(|(x, y)| low + DVec2::new(x, y)).to_vec();
    drawing.add(
        MarkKind::Outline,
        "window".to_owned(),
        None,
        vec![Stroke { points, closed: true }],
    );
    for i in 1..blocks.0 {
        let x = low.x + blocks.1 * i as f64;
        let points = vec![DVec2::new(x, low.y), DVec2::new(x, low.y + size.y)];
        drawing.add(
            MarkKind::Slit,
            format!("cut-{i}"),
            None,
            vec![Stroke { points, closed: false }],
        );
    }
    Ok(())
}

fn write(
    drawing: &mut Drawing,
    kind: MarkKind,
    id: &str,
    words: &str,
    at: DVec2,
) -> Result<(), SheetError> {
    let strokes = moved(lettering(words, LETTERS)?.strokes, at).collect();
    drawing.add(kind, id.to_owned(), None, strokes);
    Ok(())
}

fn tenths(mm: f64) -> f64 {
    (mm * 10.0).ceil() / 10.0
}

#[cfg(test)]
mod tests {
    use super::super::drawing::LayerKind;
    use super::*;

    #[test]
    fn the_comb_has_the_thickness_among_its_slots_and_everything_is_on_the_coupon() {
        for thickness in [0.3, 1.0, 3.0, 6.0] {
            let slots = slots(thickness);
            assert!(slots.iter().any(|w| (w - thickness).abs() < 1e-9), "{slots:?}");
            assert!(slots[0] > 0.0 && slots.windows(2).all(|w| w[0] < w[1]), "{slots:?}");
            let coupon = kerf_coupon(thickness, "Birch plywood").expect("a coupon");
            let points = coupon.marks().flat_map(|m| &m.strokes).flat_map(|s| &s.points);
            for p in points {
                assert!(
                    p.min_element() >= 0.0 && p.x <= coupon.width && p.y <= coupon.height,
                    "{p}"
                );
            }
            let inner =
                coupon.layers.iter().find(|l| l.kind == LayerKind::CutInner).expect("a layer");
            assert_eq!(inner.marks.len(), BLOCKS.0 - 1);
        }
        assert!(kerf_coupon(0.0, "").is_err() && kerf_coupon(f64::NAN, "").is_err());
    }

    #[test]
    fn paper_gets_a_bar_of_strips_and_no_comb() {
        let coupon = kerf_coupon(0.15, "Paper 120 g").expect("a coupon");
        let has = |id: &str| coupon.marks().any(|m| m.id == id);
        assert!(has("window") && has("how-to-push") && !has("comb") && !has("how-to-fit"));
        let inner = coupon.layers.iter().find(|l| l.kind == LayerKind::CutInner).expect("a layer");
        assert_eq!((inner.marks.len(), cuts_of_bar(0.15)), (STRIPS.0 - 1, 21));
        let card = kerf_coupon(0.4, "Card").expect("a coupon");
        assert!(card.marks().any(|m| m.id == "how-to-fit"));
    }
}
