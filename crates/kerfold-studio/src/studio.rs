//! What all tabs share: the folder, the token, and the tabs themselves.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use kerfold::io::MeshFormat;
use kerfold::recipe::StepDraft;

use crate::tab::Tab;
use crate::{StudioError, paths};

/// Tabs at once; the one that was not used for longest is closed for a new one. Its recipe is kept.
const MOST_TABS: usize = 16;

/// Where recipes are kept that nobody has saved, in the folder of the studio.
pub(crate) const KEPT: &str = ".kerfold-studio";

/// How a studio is set up.
#[derive(Debug, Clone, Default)]
pub struct StudioOptions {
    /// The folder in which files are read and written.
    pub folder: PathBuf,
    /// A recipe or a mesh in it to begin with.
    pub file: Option<String>,
    /// A folder with the page, instead of the one that is built in.
    pub page: Option<PathBuf>,
}

/// The studio: one for each server.
pub struct Studio {
    root: PathBuf,
    token: String,
    port: u16,
    file: Option<String>,
    page: Option<PathBuf>,
    tabs: Mutex<VecDeque<Arc<Tab>>>,
}

impl Studio {
    /// A studio that is reached at a port of this machine.
    ///
    /// # Errors
    /// [`StudioError::File`] when the folder is none.
    pub fn new(options: StudioOptions, port: u16) -> Result<Self, StudioError> {
        let root = options.folder.canonicalize().map_err(|error| StudioError::File {
            file: options.folder.display().to_string(),
            message: error.to_string(),
        })?;
        let StudioOptions { file, page, .. } = options;
        Ok(Self { root, token: random_name()?, port, file, page, tabs: Mutex::default() })
    }

    /// What every request has to know.
    pub fn token(&self) -> &str {
        &self.token
    }

    /// The address for a browser.
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/#token={}", self.port, self.token)
    }

    pub(crate) fn hosts(&self) -> [String; 2] {
        ["127.0.0.1", "localhost"].map(|name| format!("{name}:{}", self.port))
    }

    pub(crate) fn root(&self) -> &Path {
        &self.root
    }

    pub(crate) fn page(&self) -> Option<&Path> {
        self.page.as_deref()
    }

    /// A new tab, with the recipe that was kept of an earlier one where there is any, else with the
    /// file that the studio was started with.
    pub(crate) fn open_tab(&self, resume: Option<&str>) -> Result<Arc<Tab>, StudioError> {
        if let Some(tab) = resume.and_then(|id| self.tab(id).ok()) {
            return Ok(tab);
        }
        let tab = Arc::new(Tab::new(random_name()?, &self.root));
        let kept = resume.filter(|id| is_name(id)).and_then(|id| {
            std::fs::read_to_string(self.root.join(KEPT).join(format!("{id}.toml"))).ok()
        });
        match (kept, &self.file) {
            (Some(text), _) => self.open_text(&tab, &text)?,
            (None, Some(file)) => self.open_file(&tab, file)?,
            (None, None) => {}
        }
        let mut tabs = self.tabs();
        if tabs.len() >= MOST_TABS
            && let Some(oldest) = tabs.pop_front()
        {
            oldest.stop_all();
            oldest.keep();
        }
        tabs.push_back(tab.clone());
        Ok(tab)
    }

    pub(crate) fn tab(&self, id: &str) -> Result<Arc<Tab>, StudioError> {
        let mut tabs = self.tabs();
        let at = tabs.iter().position(|tab| tab.id == id);
        let tab = at.and_then(|at| tabs.remove(at));
        let tab =
            tab.ok_or_else(|| StudioError::NoSuchTab { tab: id.chars().take(40).collect() })?;
        tabs.push_back(tab.clone());
        Ok(tab)
    }

    /// Takes a recipe over.
    pub(crate) fn open_text(&self, tab: &Tab, text: &str) -> Result<(), StudioError> {
        let draft = match text.trim() {
            "" => return Ok(()),
            _ => kerfold::recipe::RecipeDraft::parse(text)?,
        };
        paths::check_recipe(&self.root, &draft)?;
        Ok(tab.session().open(text)?)
    }

    /// Takes a recipe or a mesh of the folder over.
    pub(crate) fn open_file(&self, tab: &Tab, file: &str) -> Result<(), StudioError> {
        let path = paths::inside(&self.root, file)?;
        let failed = |message: String| StudioError::File { file: file.to_owned(), message };
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml")) {
            let bytes = std::fs::read(&path).map_err(|error| failed(error.to_string()))?;
            let text = kerfold::io::decode_text(&bytes).map_err(|at| {
                failed(format!("this must be text in UTF-8, but byte {at} is not"))
            })?;
            if file.contains('/') {
                return Err(failed("a recipe must lie in the folder of the studio itself".into()));
            }
            self.open_text(tab, &text)?;
            tab.set_file(Some(file.to_owned()));
            return Ok(());
        }
        if MeshFormat::of_path(&path).is_none() {
            return Err(failed(
                "a mesh is a file that ends in .obj, .ply, .stl, .off, .glb or .3mf".into(),
            ));
        }
        tab.session().open(&StepDraft::new("read", file).text())?;
        tab.set_file(None);
        Ok(())
    }

    fn tabs(&self) -> MutexGuard<'_, VecDeque<Arc<Tab>>> {
        // Whoever panicked with the lock has left a list of tabs that is still one.
        self.tabs.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn random_name() -> Result<String, StudioError> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|error| StudioError::File {
        file: "the system's random numbers".to_owned(),
        message: error.to_string(),
    })?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

/// Whether a text is a name that [`random_name`] could have made: no path.
fn is_name(text: &str) -> bool {
    text.len() == 32 && text.bytes().all(|b| b.is_ascii_hexdigit())
}
