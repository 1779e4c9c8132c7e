//! Whether messages and help are coloured.

/// When messages and help are coloured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub(super) enum Colour {
    /// Where a terminal reads them.
    #[default]
    Auto,
    /// Also into files and pipes.
    Always,
    /// Nowhere.
    Never,
}

impl Colour {
    pub(super) const fn of_clap(self) -> clap::ColorChoice {
        match self {
            Self::Auto => clap::ColorChoice::Auto,
            Self::Always => clap::ColorChoice::Always,
            Self::Never => clap::ColorChoice::Never,
        }
    }
}

/// What `--color` says among arguments that are not read yet, since reading them may end with a
/// message; the last one counts, and a wrong word is told when they are read.
pub(super) fn asked_colour(arguments: impl Iterator<Item = std::ffi::OsString>) -> Colour {
    let mut colour = Colour::default();
    let mut is_next = false;
    for argument in arguments.filter_map(|argument| argument.into_string().ok()) {
        let word =
            if is_next { Some(argument.as_str()) } else { argument.strip_prefix("--color=") };
        colour = match word {
            Some("always") => Colour::Always,
            Some("never") => Colour::Never,
            Some("auto") => Colour::Auto,
            _ => colour,
        };
        is_next = argument == "--color";
    }
    colour
}
