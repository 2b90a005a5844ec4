//! Finds which file of a crate uses which names of which other file, and where this use forms a
//! circle.
//!
//! Only names count. A method call is no edge, because it needs no import of the file that has the
//! method.

#![expect(clippy::panic, reason = "the helpers of tests fail as tests do")]

use std::collections::{BTreeMap, BTreeSet};
use syn::visit::{self, Visit};
use syn::{Attribute, Item, UseTree, Visibility};

/// The names that one file uses of another file, by the two files.
pub(crate) type Edges = BTreeMap<(String, String), BTreeSet<String>>;

/// The segments of a path.
type Segments = Vec<String>;

/// A module. A file has one module, and one more for each `mod name { .. }` inside it.
struct Module {
    file: String,
    parent: usize,
    children: BTreeMap<String, usize>,
    items: BTreeSet<String>,
    imports: Vec<Import>,
    paths: Vec<Segments>,
}

/// One name of a `use`. The name is `*` for all names of a module.
struct Import {
    name: String,
    path: Segments,
    /// Whether the name is passed on (`pub`, `pub(crate)` and so on), which is no use of it.
    passed_on: bool,
}

/// The modules of one crate. The root is the first one.
struct Tree<'a> {
    read: &'a dyn Fn(&str) -> Option<String>,
    modules: Vec<Module>,
}

/// The edges between the files of a crate. `read` gives a file's source by its path below `src`.
pub(crate) fn edges(root: &str, read: &dyn Fn(&str) -> Option<String>) -> Edges {
    let mut tree = Tree {
        read,
        modules: Vec::new(),
    };
    tree.add_file(root, "", 0);
    let mut edges = Edges::new();
    for (at, module) in tree.modules.iter().enumerate() {
        let imports = module.imports.iter().filter(|import| !import.passed_on);
        for path in imports.map(|import| &import.path).chain(&module.paths) {
            if let Some((file, name)) = tree.item(at, path)
                && file != module.file
            {
                let names = edges.entry((module.file.clone(), file)).or_default();
                names.insert(name);
            }
        }
    }
    edges
}

/// Returns a sentence for each circle of files.
pub(crate) fn circles(edges: &Edges) -> Vec<String> {
    let mut next: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (from, to) in edges.keys() {
        next.entry(from).or_default().insert(to);
    }
    let reached = |start: &str| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![start]);
        while let Some(file) = open.pop() {
            for to in next.get(file).into_iter().flatten().copied() {
                if seen.insert(to) {
                    open.push(to);
                }
            }
        }
        seen
    };
    let reach: BTreeMap<&str, BTreeSet<&str>> =
        next.keys().map(|file| (*file, reached(file))).collect();
    let tied = |a: &str, b: &str| {
        let there = |a: &str, b: &str| reach.get(a).is_some_and(|files| files.contains(b));
        there(a, b) && there(b, a)
    };
    let mut told = BTreeMap::<&str, Vec<String>>::new();
    for ((from, to), names) in edges {
        if tied(from, to) {
            // All files of a circle have the same first file.
            let first = reach.keys().find(|file| tied(file, from));
            let names: Vec<_> = names.iter().map(String::as_str).collect();
            let line = format!("{from} uses {} of {to}", names.join(", "));
            told.entry(first.unwrap_or(&"")).or_default().push(line);
        }
    }
    told.into_values().map(|lines| lines.join("; ")).collect()
}

impl Tree<'_> {
    /// Adds a file's modules. `folder` holds the files of its children.
    fn add_file(&mut self, file: &str, folder: &str, parent: usize) -> usize {
        let source = (self.read)(file).unwrap_or_else(|| panic!("there is no {file}"));
        let parsed = syn::parse_file(&source).unwrap_or_else(|error| panic!("{file}: {error}"));
        self.add_module(file, folder, parent, &parsed.items)
    }

    fn add_module(&mut self, file: &str, folder: &str, parent: usize, items: &[Item]) -> usize {
        let at = self.modules.len();
        self.modules.push(Module {
            file: file.to_owned(),
            parent,
            children: BTreeMap::new(),
            items: BTreeSet::new(),
            imports: Vec::new(),
            paths: Vec::new(),
        });
        for item in items.iter().filter(|item| !is_test(attributes(item))) {
            let Item::Mod(child) = item else {
                self.modules[at].items.extend(name(item));
                self.modules[at].visit_item(item);
                continue;
            };
            let name = child.ident.to_string();
            if let Some(path) = path_of(&child.attrs) {
                // `#[path = "../NAME/mod.rs"]`: a folder beside this one.
                let outer = folder
                    .trim_end_matches('/')
                    .rsplit_once('/')
                    .map_or("", |it| it.0);
                let file = format!("{outer}/{}", path.trim_start_matches("../"));
                let folder = file.trim_end_matches("mod.rs").to_owned();
                let index = self.add_file(&file, &folder, at);
                self.modules[at].children.insert(name, index);
                continue;
            }
            let folder = format!("{folder}{name}/");
            let index = if let Some((_, items)) = &child.content {
                self.add_module(file, &folder, at, items)
            } else {
                let short = format!("{}.rs", folder.trim_end_matches('/'));
                let long = format!("{folder}mod.rs");
                let exists = (self.read)(&short).is_some();
                self.add_file(if exists { &short } else { &long }, &folder, at)
            };
            self.modules[at].children.insert(name, index);
        }
        at
    }

    /// The file and name of the item that a path leads to; `None` for modules, and outside the
    /// crate.
    fn item(&self, from: usize, path: &[String]) -> Option<(String, String)> {
        let (first, rest) = path.split_first()?;
        let module = &self.modules[from];
        match first.as_str() {
            "crate" => self.item_in(0, rest, 0),
            "self" => self.item_in(from, rest, 0),
            "super" if rest.first().is_some_and(|next| next == "super") => {
                self.item(module.parent, rest)
            }
            "super" => self.item_in(module.parent, rest, 0),
            name if module.knows(name) => self.item_in(from, path, 0),
            _ => None,
        }
    }

    fn item_in(&self, at: usize, path: &[String], depth: usize) -> Option<(String, String)> {
        let (first, rest) = path.split_first()?;
        let module = &self.modules[at];
        if let Some(child) = module.children.get(first) {
            return self.item_in(*child, rest, depth);
        }
        let import = module.imports.iter().find(|import| import.name == *first);
        if let (Some(import), false) = (import, module.items.contains(first) || depth > 20) {
            let path: Segments = import.path.iter().chain(rest).cloned().collect();
            let inside = matches!(path[0].as_str(), "crate" | "self" | "super");
            return if inside || module.children.contains_key(&path[0]) {
                self.item(at, &path)
            } else {
                None
            };
        }
        Some((module.file.clone(), first.clone()))
    }
}

impl Module {
    /// Whether a path that starts with this name stays inside the crate.
    fn knows(&self, name: &str) -> bool {
        let imported = self.imports.iter().any(|import| import.name == name);
        imported || self.children.contains_key(name)
    }

    fn import(&mut self, tree: &UseTree, before: &[String], passed_on: bool) {
        let with = |ident: &dyn ToString| {
            let ident = ident.to_string();
            let own = (ident != "self" || before.is_empty()).then_some(ident);
            before.iter().cloned().chain(own).collect::<Segments>()
        };
        let (path, name) = match tree {
            UseTree::Path(path) => return self.import(&path.tree, &with(&path.ident), passed_on),
            UseTree::Group(group) => {
                let trees = group.items.iter();
                return trees.for_each(|tree| self.import(tree, before, passed_on));
            }
            UseTree::Name(name) => (with(&name.ident), None),
            UseTree::Rename(name) => (with(&name.ident), Some(name.rename.to_string())),
            UseTree::Glob(_) => (with(&"*"), Some("*".to_owned())),
        };
        let name = name.or_else(|| path.last().cloned()).unwrap_or_default();
        assert!(
            name != "*" || !passed_on,
            "pass names on one by one, not all of {path:?}"
        );
        self.imports.push(Import {
            name,
            path,
            passed_on,
        });
    }
}

impl<'ast> Visit<'ast> for Module {
    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        self.import(&item.tree, &[], !matches!(item.vis, Visibility::Inherited));
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let segments = path.segments.iter();
        self.paths
            .push(segments.map(|segment| segment.ident.to_string()).collect());
        visit::visit_path(self, path);
    }

    /// The input of a macro is not parsed yet, so every word in it may be a path.
    fn visit_macro(&mut self, item: &'ast syn::Macro) {
        let text = item.tokens.to_string().replace(" :: ", "::");
        let words = text.split(|c: char| !c.is_alphanumeric() && !"_:".contains(c));
        for word in words.map(|word| word.trim_matches(':')) {
            self.paths
                .push(word.split("::").map(str::to_owned).collect());
        }
    }

    fn visit_attribute(&mut self, _: &'ast Attribute) {}
}

/// Whether an item exists in tests only.
fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let argument = attribute.parse_args::<syn::Ident>();
        attribute.path().is_ident("cfg") && argument.is_ok_and(|argument| argument == "test")
    })
}

/// The value of an attribute `path`.
fn path_of(attributes: &[Attribute]) -> Option<String> {
    let own = attributes.iter().find(|own| own.path().is_ident("path"))?;
    let syn::Meta::NameValue(pair) = &own.meta else {
        return None;
    };
    let syn::Expr::Lit(literal) = &pair.value else {
        return None;
    };
    match &literal.lit {
        syn::Lit::Str(path) => Some(path.value()),
        _ => None,
    }
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// The name that an item defines.
fn name(item: &Item) -> Option<String> {
    let ident = match item {
        Item::Const(item) => &item.ident,
        Item::Enum(item) => &item.ident,
        Item::Fn(item) => &item.sig.ident,
        Item::Static(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::Type(item) => &item.ident,
        _ => return None,
    };
    Some(ident.to_string())
}
