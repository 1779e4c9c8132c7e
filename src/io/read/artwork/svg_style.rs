//! How SVG is painted: presentation attributes, style sheets with simple selectors, `style`.

use std::collections::HashMap;

use roxmltree::{Document, Node};

/// The properties that matter to a judge of lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Property {
    Stroke,
    Fill,
    Color,
    Display,
    Visibility,
    ClipPath,
    Mask,
}

const PROPERTIES: [(Property, &str); 7] = [
    (Property::Stroke, "stroke"),
    (Property::Fill, "fill"),
    (Property::Color, "color"),
    (Property::Display, "display"),
    (Property::Visibility, "visibility"),
    (Property::ClipPath, "clip-path"),
    (Property::Mask, "mask"),
];

/// The values that hold for one element; later ones replace earlier ones, but for `!important`.
#[derive(Debug, Clone, Default)]
pub(super) struct Declared {
    values: [Option<(String, bool)>; PROPERTIES.len()],
}

impl Declared {
    pub fn get(&self, property: Property) -> Option<&str> {
        let value = self.values[property as usize].as_ref().map(|v| v.0.as_str());
        value.filter(|v| *v != "inherit")
    }

    fn set(&mut self, name: &str, value: &str) {
        let Some(&(property, _)) = PROPERTIES.iter().find(|(_, known)| *known == name) else {
            return;
        };
        let (value, is_important) = match value.split_once('!') {
            Some((value, _)) => (value, true),
            None => (value, false),
        };
        self.put(property, value.trim(), is_important);
    }

    fn put(&mut self, property: Property, value: &str, is_important: bool) {
        let slot = &mut self.values[property as usize];
        if is_important || slot.as_ref().is_none_or(|(_, was_important)| !was_important) {
            *slot = Some((value.to_owned(), is_important));
        }
    }

    /// `name: value; name: value`.
    fn read(&mut self, text: &str) {
        for declaration in text.split(';') {
            if let Some((name, value)) = declaration.split_once(':') {
                self.set(name.trim(), value.trim());
            }
        }
    }

    fn extend(&mut self, other: &Self) {
        for (property, _) in PROPERTIES {
            if let Some((value, is_important)) = &other.values[property as usize] {
                self.put(property, value, *is_important);
            }
        }
    }
}

/// Style rules by selector: a tag, a class with its dot, an id with its hash, or `*`.
#[derive(Debug, Default)]
pub(super) struct Rules {
    by_selector: HashMap<String, Declared>,
    /// How many selectors are not read.
    pub unread: usize,
}

impl Rules {
    pub fn of(document: &Document<'_>) -> Self {
        let mut rules = Self::default();
        for sheet in document.descendants().filter(|n| n.tag_name().name() == "style") {
            let text: String =
                sheet.descendants().filter(|n| n.is_text()).filter_map(|n| n.text()).collect();
            rules.read(&without_comments(&text));
        }
        rules
    }

    fn read(&mut self, text: &str) {
        for block in text.split('}') {
            let Some((selectors, body)) = block.split_once('{') else { continue };
            let mut declared = Declared::default();
            declared.read(body);
            for selector in selectors.split(',').map(str::trim) {
                let name = selector.strip_prefix(['.', '#']).unwrap_or(selector);
                let is_word = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_');
                if selector == "*" || (!name.is_empty() && name.chars().all(is_word)) {
                    self.by_selector.entry(selector.to_owned()).or_default().extend(&declared);
                } else {
                    self.unread += 1;
                }
            }
        }
    }

    /// What holds for an element: attributes are weaker than rules, rules weaker than its `style`.
    pub fn declared(&self, node: Node<'_, '_>) -> Declared {
        let mut declared = Declared::default();
        for (property, name) in PROPERTIES {
            if let Some(value) = node.attribute(name) {
                declared.put(property, value.trim(), false);
            }
        }
        let mut apply = |selector: &str| {
            if let Some(rule) = self.by_selector.get(selector) {
                declared.extend(rule);
            }
        };
        if !self.by_selector.is_empty() {
            apply("*");
            apply(node.tag_name().name());
            let classes = node.attribute("class").unwrap_or_default().split_whitespace();
            classes.for_each(|class| apply(&format!(".{class}")));
            node.attribute("id").into_iter().for_each(|id| apply(&format!("#{id}")));
        }
        node.attribute("style").into_iter().for_each(|style| declared.read(style));
        declared
    }
}

fn without_comments(text: &str) -> String {
    let parts = text.split("/*").enumerate();
    parts
        .map(|(i, part)| if i == 0 { part } else { part.split_once("*/").map_or("", |p| p.1) })
        .collect()
}
