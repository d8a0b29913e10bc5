//! Arguments of every command that draws.

use std::path::{Path, PathBuf};

use clap::Args as ClapArgs;
use hydrostat_figures::Page;
use hydrostat_files::Dimension;

/// The forms of a picture, which the ending of its file chooses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Form {
    Svg,
    Pdf,
    Png,
}

const FORMS: [(&str, Form); 3] = [("svg", Form::Svg), ("pdf", Form::Pdf), ("png", Form::Png)];

/// The form that the ending of `path` asks for.
pub(crate) fn form(path: &Path) -> Option<Form> {
    let ending = path.extension()?;
    FORMS.into_iter().find(|(own, _)| ending.eq_ignore_ascii_case(own)).map(|(_, form)| form)
}

/// A path whose ending says what to draw.
pub(crate) fn picture(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match form(&path) {
        Some(_) => Ok(path),
        None => Err("expected a file name that ends in .svg, .pdf or .png".to_owned()),
    }
}

// How wide a picture is and how it is written. As a doc comment this would replace the help of each command.
#[derive(Debug, Clone, Default, ClapArgs)]
pub(crate) struct PageArgs {
    /// Width of the picture, from '70 mm' to '1000 mm' [default: 159 mm]; the text size does not change
    #[arg(long, value_name = "WIDTH", value_parser = width, allow_hyphen_values = true)]
    width: Option<Page>,
    /// In SVG, write text as editable text instead of outlines
    #[arg(long)]
    pub(crate) svg_text: bool,
}

// The same, with the title.
#[derive(Debug, Clone, ClapArgs)]
pub(crate) struct PictureArgs {
    /// Title of the picture; "" for none
    #[arg(long, value_name = "TEXT", allow_hyphen_values = true)]
    title: Option<String>,
    #[command(flatten)]
    pub(crate) page: PageArgs,
}

impl PageArgs {
    pub(crate) fn page(&self) -> Page {
        self.width.clone().unwrap_or_default()
    }

    fn given(&self) -> Option<&'static str> {
        if self.width.is_some() { Some("--width") } else { self.svg_text.then_some("--svg-text") }
    }
}

impl PictureArgs {
    pub(crate) fn page(&self) -> Page {
        Page { title: self.title.clone(), ..self.page.page() }
    }

    /// The first option of these that is given.
    pub(crate) fn given(&self) -> Option<&'static str> {
        self.title.as_ref().map(|_| "--title").or_else(|| self.page.given())
    }
}

fn width(text: &str) -> Result<Page, String> {
    let expected =
        || format!("expected a width from 70 mm to 1000 mm with its unit, such as \"85 mm\"; found \"{text}\"");
    let (metres, _) = Dimension::Length.read(text.trim().trim_matches('"')).map_err(|_| expected())?;
    Page::of_width(metres).ok_or_else(expected)
}
