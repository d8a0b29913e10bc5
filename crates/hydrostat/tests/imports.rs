//! No circle of files: inside every crate of the workspace, imports between source files run one way.
//!
//! An arrow from file A to file B means: code of A outside its tests names an item that B defines. The name may reach A
//! by `use`, by a path such as `super::mesh::Mesh::new()`, or through another module's `pub use`. A `mod` line is no
//! import, and neither is a call of a method.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// One `use` of one name: `use a::b as c` has the path [a, b] and the name c; a glob has the name `*`.
struct Import {
    path: Vec<String>,
    name: String,
}

/// A module of a crate: a file, or a `mod name { ... }` inside one.
#[derive(Default)]
struct Module {
    file: PathBuf,
    parent: Option<usize>,
    children: BTreeMap<String, usize>,
    defined: BTreeSet<String>,
    imports: Vec<Import>,
    /// Other paths of two names or more in the module's code.
    paths: Vec<Vec<String>>,
}

/// What a path leads to.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Found {
    Module(usize),
    /// An item that this module defines.
    Item(usize),
}

/// The modules of one crate, the root first.
struct Crate {
    modules: Vec<Module>,
}

/// Where the text of a file comes from: the disk, or a made-up crate.
type Read<'a> = &'a dyn Fn(&Path) -> Option<String>;

impl Crate {
    fn read(root: &Path, read: Read) -> Self {
        let mut this = Self { modules: Vec::new() };
        let folder = root.parent().expect("a source file is in a folder");
        this.add_file(root, folder, None, read);
        this
    }

    /// Adds the module of a file, whose children are in `folder`.
    fn add_file(&mut self, file: &Path, folder: &Path, parent: Option<usize>, read: Read) -> usize {
        let text = read(file).unwrap_or_else(|| panic!("{} is declared and not there", file.display()));
        let tokens: TokenStream = text.parse().unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        self.add_module(tokens, file, folder, parent, read)
    }

    fn add_module(
        &mut self,
        tokens: TokenStream,
        file: &Path,
        folder: &Path,
        parent: Option<usize>,
        read: Read,
    ) -> usize {
        let number = self.modules.len();
        self.modules.push(Module { file: file.to_path_buf(), parent, ..Module::default() });
        self.scan(number, folder, tokens, true, read);
        number
    }

    /// Reads tokens of a module: definitions and child modules where `items` says that they stand at its top, and the
    /// imports and paths at any depth.
    fn scan(&mut self, module: usize, folder: &Path, tokens: TokenStream, items: bool, read: Read) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let mut at = 0;
        let mut declared_path = None;
        while at < tokens.len() {
            // An attribute: what stands for tests alone is passed over, with the item that it marks.
            if punct(&tokens, at, '#') {
                let inner = at + 1 + usize::from(punct(&tokens, at + 1, '!'));
                if let Some(TokenTree::Group(group)) = tokens.get(inner) {
                    let text: String = group.stream().to_string().split_whitespace().collect();
                    at = inner + 1;
                    if text == "cfg(test)" {
                        at = past_item(&tokens, at, items);
                    } else if let Some(path) = text.strip_prefix("path=") {
                        declared_path = Some(path.trim_matches('"').to_owned());
                    } else if !text.starts_with("doc") {
                        self.scan(module, folder, group.stream(), false, read);
                    }
                    continue;
                }
            }
            let word = ident(&tokens, at);
            match word.as_deref() {
                Some("use") => {
                    let end = (at..tokens.len()).find(|&i| punct(&tokens, i, ';')).unwrap_or(tokens.len());
                    use_tree(&tokens[at + 1..end], &[], &mut self.modules[module].imports);
                    at = end + 1;
                }
                Some("mod") if items && ident(&tokens, at + 1).is_some() => {
                    let name = ident(&tokens, at + 1).expect("just seen");
                    let child = if let Some(TokenTree::Group(body)) = tokens.get(at + 2) {
                        let file = self.modules[module].file.clone();
                        self.add_module(body.stream(), &file, &folder.join(&name), Some(module), read)
                    } else {
                        let (file, below) = child_file(folder, &name, declared_path.take(), read);
                        self.add_file(&file, &below, Some(module), read)
                    };
                    self.modules[module].children.insert(name, child);
                    at += 3;
                }
                Some("struct" | "enum" | "union" | "fn" | "trait" | "type" | "const" | "static" | "macro_rules")
                    if items =>
                {
                    // `const fn name`, `static mut name`, `macro_rules! name`: the name is the last of the words.
                    let mut next = at + 1 + usize::from(punct(&tokens, at + 1, '!'));
                    while matches!(ident(&tokens, next).as_deref(), Some("fn" | "unsafe" | "mut" | "extern")) {
                        next += 1;
                    }
                    if let Some(name) = ident(&tokens, next) {
                        self.modules[module].defined.insert(name);
                        next += 1;
                    }
                    at = next;
                }
                Some(_) => {
                    let mut path = vec![word.expect("just seen")];
                    at += 1;
                    while punct(&tokens, at, ':') && punct(&tokens, at + 1, ':') {
                        let Some(next) = ident(&tokens, at + 2) else { break };
                        path.push(next);
                        at += 3;
                    }
                    if path.len() > 1 {
                        self.modules[module].paths.push(path);
                    }
                }
                None => {
                    if let TokenTree::Group(group) = &tokens[at] {
                        self.scan(module, folder, group.stream(), false, read);
                    }
                    at += 1;
                }
            }
        }
    }

    /// What a path means inside a module. None for what is outside the crate.
    fn resolve(&self, from: usize, path: &[String]) -> Vec<Found> {
        let mut seen = BTreeSet::new();
        self.walk(from, path, true, &mut seen)
    }

    /// `first` says that the path starts here, so that `crate`, `self` and `super` have their meaning.
    fn walk(
        &self,
        module: usize,
        path: &[String],
        first: bool,
        seen: &mut BTreeSet<(usize, Vec<String>)>,
    ) -> Vec<Found> {
        let Some((name, rest)) = path.split_first() else { return vec![Found::Module(module)] };
        if !seen.insert((module, path.to_vec())) {
            return Vec::new();
        }
        match name.as_str() {
            "crate" if first => return self.walk(0, rest, true, seen),
            "self" if first => return self.walk(module, rest, true, seen),
            "super" if first => {
                return self.modules[module].parent.map_or(Vec::new(), |up| self.walk(up, rest, true, seen));
            }
            _ => {}
        }
        let here = &self.modules[module];
        let mut found = Vec::new();
        // A module and an item may share a name: a longer path means the module.
        if let Some(&child) = here.children.get(name) {
            found.extend(self.walk(child, rest, false, seen));
        }
        if here.defined.contains(name) && (rest.is_empty() || found.is_empty()) {
            found.push(Found::Item(module));
        }
        if found.is_empty() {
            for import in here.imports.iter().filter(|import| import.name == *name) {
                for target in self.walk(module, &import.path, true, seen) {
                    match target {
                        Found::Module(target) => found.extend(self.walk(target, rest, false, seen)),
                        Found::Item(_) => found.push(target),
                    }
                }
            }
        }
        if found.is_empty() {
            for import in here.imports.iter().filter(|import| import.name == "*") {
                for target in self.walk(module, &import.path, true, seen) {
                    if let Found::Module(target) = target {
                        found.extend(self.walk(target, path, false, seen));
                    }
                }
            }
        }
        found
    }

    /// The arrows between files, with the names that each takes.
    fn arrows(&self) -> Arrows {
        let mut arrows = Arrows::new();
        for (number, module) in self.modules.iter().enumerate() {
            let imported = module.imports.iter().map(|import| &import.path);
            for path in imported.chain(&module.paths) {
                for found in self.resolve(number, path) {
                    let (Found::Module(target) | Found::Item(target)) = found;
                    let file = &self.modules[target].file;
                    if *file != module.file {
                        let names = arrows.entry(module.file.clone()).or_default().entry(file.clone()).or_default();
                        names.insert(path.last().expect("a path has a name").clone());
                    }
                }
            }
        }
        arrows
    }
}

/// From file to file, with the names that the first takes of the second.
type Arrows = BTreeMap<PathBuf, BTreeMap<PathBuf, BTreeSet<String>>>;

fn punct(tokens: &[TokenTree], at: usize, mark: char) -> bool {
    matches!(tokens.get(at), Some(TokenTree::Punct(punct)) if punct.as_char() == mark)
}

fn ident(tokens: &[TokenTree], at: usize) -> Option<String> {
    match tokens.get(at) {
        Some(TokenTree::Ident(ident)) => Some(ident.to_string()),
        _ => None,
    }
}

/// The place after the item that starts at a place: after its `;`, or after its braces. Inside items, what is marked
/// may also be a field, which ends at a comma.
fn past_item(tokens: &[TokenTree], mut at: usize, items: bool) -> usize {
    while at < tokens.len() {
        let end = match &tokens[at] {
            TokenTree::Punct(punct) => punct.as_char() == ';' || (!items && punct.as_char() == ','),
            TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
            _ => false,
        };
        // The braces of `use a::{b};` are not its end.
        if end && !punct(tokens, at + 1, ';') {
            return at + 1;
        }
        at += 1;
    }
    at
}

/// Where the file of `mod name;` is, and the folder of its children.
fn child_file(folder: &Path, name: &str, declared: Option<String>, read: Read) -> (PathBuf, PathBuf) {
    if let Some(declared) = declared {
        let file = folder.join(declared);
        let below = file.parent().expect("a file is in a folder").to_path_buf();
        return (file, below);
    }
    let plain = folder.join(format!("{name}.rs"));
    let below = folder.join(name);
    if read(&plain).is_some() { (plain, below) } else { (below.join("mod.rs"), below) }
}

/// The imports of what stands between `use` and `;`.
fn use_tree(tokens: &[TokenTree], before: &[String], imports: &mut Vec<Import>) {
    let mut path = before.to_vec();
    let mut at = 0;
    while at < tokens.len() {
        match &tokens[at] {
            TokenTree::Group(group) => {
                let inner: Vec<TokenTree> = group.stream().into_iter().collect();
                for part in inner.split(|token| matches!(token, TokenTree::Punct(p) if p.as_char() == ',')) {
                    if !part.is_empty() {
                        use_tree(part, &path, imports);
                    }
                }
                return;
            }
            TokenTree::Punct(punct) if punct.as_char() == '*' => {
                imports.push(Import { path, name: "*".to_owned() });
                return;
            }
            TokenTree::Ident(word) if word == "as" => {
                let name = ident(tokens, at + 1).unwrap_or_default();
                imports.push(Import { path, name });
                return;
            }
            // `use a::{self}` is `use a`.
            TokenTree::Ident(word) if word == "self" && !path.is_empty() => {}
            TokenTree::Ident(word) => path.push(word.to_string()),
            _ => {}
        }
        at += 1;
    }
    if let Some(name) = path.last().cloned() {
        imports.push(Import { path, name });
    }
}

/// A shortest circle of arrows, if there is one, as lines of text.
fn circle(arrows: &Arrows) -> Option<String> {
    let mut shortest: Option<Vec<&PathBuf>> = None;
    for start in arrows.keys() {
        // Breadth first from every file, until the way back to it.
        let mut came_from: BTreeMap<&PathBuf, &PathBuf> = BTreeMap::new();
        let mut row = vec![start];
        while !row.is_empty() && !came_from.contains_key(start) {
            let mut next = Vec::new();
            for file in row {
                for target in arrows.get(file).into_iter().flat_map(BTreeMap::keys) {
                    if !came_from.contains_key(target) {
                        came_from.insert(target, file);
                        next.push(target);
                    }
                }
            }
            row = next;
        }
        let Some(&last) = came_from.get(start) else { continue };
        let mut around = vec![start, last];
        while around.last() != Some(&start) {
            around.push(came_from[around[around.len() - 1]]);
        }
        around.reverse();
        if shortest.as_ref().is_none_or(|shortest| around.len() < shortest.len()) {
            shortest = Some(around);
        }
    }
    let lines = shortest?
        .windows(2)
        .map(|pair| {
            let names: Vec<&str> = arrows[pair[0]][pair[1]].iter().map(String::as_str).collect();
            format!("  {} takes {} from {}", pair[0].display(), names.join(", "), pair[1].display())
        })
        .collect::<Vec<_>>();
    Some(lines.join("\n"))
}

/// The first source files of all crates of the workspace.
fn roots() -> Vec<PathBuf> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut crates: Vec<PathBuf> = fs::read_dir(workspace.join("crates"))
        .expect("the crates")
        .map(|entry| entry.expect("a crate").path())
        .collect();
    crates.push(workspace.join("validation/study"));
    crates.sort();
    let roots: Vec<PathBuf> = crates
        .iter()
        .flat_map(|folder| ["src/lib.rs", "src/main.rs"].map(|file| folder.join(file)))
        .filter(|file| file.is_file())
        .collect();
    assert!(roots.len() >= crates.len(), "every crate has a first file");
    roots
}

/// The arrows of a made-up crate.
fn of(files: &[(&str, &str)]) -> Arrows {
    let read = |path: &Path| files.iter().find(|(name, _)| Path::new(name) == path).map(|(_, text)| (*text).to_owned());
    Crate::read(Path::new("src/lib.rs"), &read).arrows()
}

#[test]
fn imports_between_files_run_one_way() {
    let read = |path: &Path| fs::read_to_string(path).ok();
    let mut files = 0;
    let circles: Vec<String> = roots()
        .iter()
        .filter_map(|root| {
            let read = Crate::read(root, &read);
            files += read.modules.iter().map(|module| &module.file).collect::<BTreeSet<_>>().len();
            circle(&read.arrows())
        })
        .collect();
    assert!(circles.is_empty(), "files import each other in a circle:\n{}", circles.join("\n\n"));
    assert!(files > 250, "only {files} files were read");
}

/// The rooms of the mechanics, each of which imports only itself and those before it.
#[test]
fn rooms_of_the_mechanics_import_those_below_them() {
    const ROOMS: [&str; 4] = ["numerics", "rod", "statics", "inverse"];
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let arrows = Crate::read(&source.join("lib.rs"), &|path| fs::read_to_string(path).ok()).arrows();
    let room = |file: &Path| {
        let first = file.strip_prefix(&source).ok()?.components().next()?;
        ROOMS.iter().position(|room| Path::new(first.as_os_str()).file_stem() == Some(room.as_ref()))
    };
    let mut seen = 0;
    for (file, targets) in &arrows {
        for (target, names) in targets {
            if let (Some(from), Some(to)) = (room(file), room(target)) {
                assert!(to <= from, "{} takes {names:?} from {}", file.display(), target.display());
                seen += usize::from(to < from);
            }
        }
    }
    assert!(seen > 50, "only {seen} imports between rooms were read");
}

#[test]
fn a_circle_is_found_however_it_is_closed() {
    let lib = ("src/lib.rs", "mod a;\nmod b;\npub use a::First;");
    let a = ("src/a.rs", "use crate::b::{self, Second as Other};\npub struct First(Other);");
    for back in [
        "use crate::a::First;\npub struct Second(First);",
        "use super::First;\npub struct Second(First);",
        "pub struct Second;\nfn f() { let _ = crate::a::First::new(); }",
        "use super::a;\npub struct Second(a::First);",
        "use super::*;\npub struct Second(First);",
        "pub struct Second;\nmacro_rules! m { () => { $crate::a::First } }",
    ] {
        let found = circle(&of(&[lib, a, ("src/b.rs", back)]));
        let text = found.unwrap_or_else(|| panic!("no circle by {back:?}"));
        assert!(text.contains("src/a.rs takes") && text.contains("from src/a.rs"), "{text}");
    }
}

#[test]
fn what_is_no_import_closes_no_circle() {
    let lib = ("src/lib.rs", "mod a;\nmod b;\npub use a::First;");
    let a = ("src/a.rs", "use crate::b::Second;\npub struct First(Second);");
    for back in [
        "pub struct Second;",
        "//! Of [`crate::a::First`].\npub struct Second; // crate::a::First",
        "pub struct Second;\n#[cfg(test)]\nmod tests {\n    use crate::a::First;\n}",
        "pub struct Second {\n    #[cfg(test)]\n    seen: Option<crate::a::First>,\n    of: usize,\n}",
        "pub struct Second;\nconst TEXT: &str = \"crate::a::First\";",
    ] {
        assert_eq!(circle(&of(&[lib, a, ("src/b.rs", back)])), None, "{back:?}");
    }
}

/// A folder's first file may hand on what its files define, and these may take it from there of each other.
#[test]
fn a_module_that_hands_on_names_is_passed_through() {
    let files = |second: &'static str| {
        [
            ("src/lib.rs", "mod room;"),
            ("src/room.rs", "mod first;\nmod second;\npub use self::first::First;\npub fn own() {}"),
            ("src/room/first.rs", "pub struct First;"),
            ("src/room/second.rs", second),
        ]
    };
    assert_eq!(circle(&of(&files("use super::First;"))), None);
    assert_eq!(circle(&of(&files("use super::own;"))), None, "nothing of the second file is handed on");
    let mut closed = files("use super::own;\npub struct Second;");
    closed[1].1 = "mod first;\nmod second;\npub use self::second::Second;\npub fn own() {}";
    assert!(circle(&of(&closed)).is_some());
}
