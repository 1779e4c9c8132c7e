//! Which file uses which, names followed through `use` and re-exports to the file that defines
//! them, and the pairs of files that use each other.

use std::collections::{BTreeMap, BTreeSet};

use super::source::{Source, UsedPath};

/// A module as a path: the name of its crate, then the modules down to it.
type Module = Vec<String>;

/// The modules of all crates with what a path in them can begin with.
pub struct House<'a> {
    rooms: BTreeMap<Module, Room<'a>>,
}

struct Room<'a> {
    source: &'a Source,
    /// Names that `use` brings in, with the paths behind them.
    names: BTreeMap<String, Vec<String>>,
    /// Paths whose names are all brought in: `use super::ids::*`.
    globs: Vec<Vec<String>>,
    /// Items that the file itself defines.
    items: BTreeSet<&'a str>,
}

/// Names are re-exported a few times at most; a longer chain is a `use` that leads to itself.
const LONGEST_CHAIN: usize = 16;

impl<'a> House<'a> {
    pub fn new(sources: &'a [Source]) -> Self {
        let rooms = sources.iter().filter_map(|source| Some((source.module_path()?, source)));
        Self { rooms: rooms.map(|(module, source)| (module, Room::new(source))).collect() }
    }

    /// Pairs of modules side by side in one room that use each other, with all that is in them. A
    /// module and its children belong together: `mod.rs` calls them, and they use its types.
    pub fn circles(&self) -> Vec<String> {
        let mut arrows: BTreeMap<(&[String], &[String]), String> = BTreeMap::new();
        let uses: Vec<(&Module, BTreeSet<Module>)> =
            self.rooms.iter().map(|(module, room)| (module, self.used_by(module, room))).collect();
        for (module, others) in &uses {
            for other in others {
                let shared = module.iter().zip(other).take_while(|(a, b)| a == b).count();
                if shared < module.len().min(other.len()) {
                    let arrow = (&module[..=shared], &other[..=shared]);
                    let files = [*module, other].map(|m| self.rooms[m].source.path.as_str());
                    arrows.entry(arrow).or_insert_with(|| files.join(" uses "));
                }
            }
        }
        let pairs = arrows.iter().filter(|((from, to), _)| from < to);
        pairs
            .filter_map(|((from, to), there)| {
                let back = arrows.get(&(*to, *from))?;
                Some(format!("{} and {}: {there}, {back}", from.join("::"), to.join("::")))
            })
            .collect()
    }

    /// The modules that define what a file names.
    fn used_by(&self, module: &Module, room: &Room) -> BTreeSet<Module> {
        let paths = room.source.paths();
        let owners = paths.iter().filter_map(|path| self.owner(module, &path.segments, 0));
        owners.filter(|owner| owner != module).collect()
    }

    /// The module that defines what a path means in `from`; none for modules themselves and for
    /// what comes from outside.
    fn owner(&self, from: &Module, path: &[String], links: usize) -> Option<Module> {
        let first = path.first().filter(|_| links < LONGEST_CHAIN)?;
        let is_crate = super::CRATES.iter().any(|(name, _)| name == first);
        let mut at = from.clone();
        let mut rest = path;
        match first.as_str() {
            "crate" => at.truncate(1),
            "self" => {}
            "super" => return self.owner(&from[..from.len() - 1].to_vec(), &up(path), links),
            _ if is_crate => at = vec![first.clone()],
            _ => return self.follow(&at, rest, links),
        }
        rest = &rest[1..];
        self.follow(&at, rest, links)
    }

    /// Goes down from a module by names it declares or brings in.
    fn follow(&self, at: &Module, path: &[String], links: usize) -> Option<Module> {
        let (name, rest) = path.split_first()?;
        let mut child = at.clone();
        child.push(name.clone());
        if self.rooms.contains_key(&child) {
            return self.follow(&child, rest, links);
        }
        let room = self.rooms.get(at)?;
        if let Some(meant) = room.names.get(name) {
            let whole: Vec<String> = meant.iter().chain(rest).cloned().collect();
            return self.owner(at, &whole, links + 1);
        }
        if room.items.contains(name.as_str()) {
            return Some(at.clone());
        }
        room.globs.iter().find_map(|glob| {
            let whole: Vec<String> = glob.iter().chain(path).cloned().collect();
            self.owner(at, &whole, links + 1)
        })
    }
}

impl<'a> Room<'a> {
    fn new(source: &'a Source) -> Self {
        let (mut names, mut globs) = (BTreeMap::new(), Vec::new());
        for UsedPath { segments, name, .. } in source.paths() {
            match name.as_deref() {
                Some("*") => globs.push(segments[..segments.len() - 1].to_vec()),
                // `use crate::geom;` needs no entry under its own first name.
                Some(name) if segments[0] != name => drop(names.insert(name.to_owned(), segments)),
                _ => {}
            }
        }
        let tokens = source.tokens.windows(2);
        let definitions = tokens.filter(|pair| KINDS.contains(&pair[0].text.as_str()));
        let items = definitions.map(|pair| pair[1].text.as_str()).collect();
        Self { source, names, globs, items }
    }
}

/// The words that begin an item with a name.
const KINDS: &[&str] = &["fn", "struct", "enum", "trait", "type", "const", "static"];

/// `super::a` seen from the module above: `self::a`, and `super::super::a`: `super::a`.
fn up(path: &[String]) -> Vec<String> {
    let mut rest = path[1..].to_vec();
    if rest.first().is_none_or(|first| first != "super") {
        rest.insert(0, "self".to_owned());
    }
    rest
}
