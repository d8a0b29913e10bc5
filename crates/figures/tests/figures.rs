//! What the drawings hold, and that all their forms are pictures.

use hydrostat::{
    Arm, BaseDirections, Cable, Gravity, Material, Options, Parameter, PathOptions, Profile, Space, SpatialSolver,
};
use hydrostat_figures::source::Finding::{Holds, InPart, Open};
use hydrostat_figures::source::{Finding, Shown, Study, StudyError, TIP_ANGLE};
use hydrostat_figures::{
    Abscissa, Page, Quantity, arm_figure, equilibria_figure, over_figure, path_figure, path_shapes_figure,
    reach_figure, spatial_arm_figure,
};

fn page() -> Page {
    Page::default()
}

fn arm() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    "two <cables> & more".clone_into(&mut arm.name);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.3));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm.flow.speed = 0.1;
    arm.gravity = Some(Gravity::default());
    arm
}

fn source_arm() -> Arm {
    let mut arm = Arm::cone(0.2, 0.010, 0.0008, 500e3, 0.5);
    arm.material = Material::Coefficients { c1: 500e3.into(), c2: (500e3 / 3.0).into(), c3: 150.0.into() };
    arm.cables.push(Cable::new("left", Profile::linear(0.008, 0.0001)));
    arm.cables.push(Cable::new("right", Profile::linear(-0.008, -0.0001)));
    arm
}

#[test]
fn an_arm_is_drawn_with_what_acts_on_it() {
    let still = arm_figure(&Arm::cone(0.2, 0.01, 0.002, 1e5, 0.5).solve().unwrap(), None, &page());
    assert!(
        !still.texts().any(|text| text.contains("stream") || text.contains("gravity")),
        "nothing acts, nothing is said"
    );
    let figure = arm_figure(&arm().solve().unwrap(), Some("a note"), &page());
    let texts: Vec<&str> = figure.texts().collect();
    for text in ["two <cables> & more", "a note", "left: 0.3 N", "right: slack", "stream 0.1 m/s", "gravity", "x (mm)"]
    {
        assert!(texts.contains(&text), "{text}: {texts:?}");
    }
    assert!(texts.iter().any(|t| t.starts_with("α(L) = ")));
}

#[test]
fn an_arm_in_space_is_drawn_from_four_sides() {
    let mut arm = arm();
    arm.inner_radius = 0.001.into();
    let base = BaseDirections { direction: [0.0, 0.2, 1.0], section: None };
    arm.space = Some(Space { stream: Some([1.0, 0.0, 1.0]), base: Some(base), ..Space::default() });
    let shape = SpatialSolver::new(&arm, Options::default()).unwrap().solve().unwrap();
    for width in [0.07, 0.159, 0.5] {
        let figure = spatial_arm_figure(&shape, Some("a note"), &Page::of_width(width).unwrap());
        let texts: Vec<&str> = figure.texts().collect();
        let all =
            ["a note", "left: 0.3 N", "stream 0.1 m/s", "gravity", "x (mm)", "y (mm)", "z (mm)", "a", "b", "c", "e3"];
        for text in all {
            assert!(texts.contains(&text), "{text}: {texts:?}");
        }
        assert!(texts.iter().any(|t| t.starts_with("α(L) = ")) && texts.iter().any(|t| t.ends_with("mm at mid-depth")));
        let svg = figure.svg();
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        assert_eq!(&figure.png().unwrap()[1..4], b"PNG");
    }
}

#[test]
fn svg_is_escaped_and_of_the_page_size() {
    let figure = arm_figure(&arm().solve().unwrap(), None, &page());
    let svg = figure.svg();
    assert!(svg.contains("aria-label=\"two &lt;cables&gt; &amp; more\""));
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
    let [width, height] = figure.size();
    assert!(width > 300.0 && height > 100.0);
    assert!(svg.contains(&format!("width=\"{width}pt\"")));
}

#[test]
fn png_has_300_dots_an_inch() {
    let figure = arm_figure(&arm().solve().unwrap(), None, &page());
    let bytes = figure.png().unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert!((f64::from(info.width) - figure.size()[0] / 72.0 * 300.0).abs() <= 0.5);
    assert!((f64::from(info.height) - figure.size()[1] / 72.0 * 300.0).abs() <= 0.5);
    // Mostly paper, but not only.
    let dark = pixels.iter().filter(|p| **p < 128).count() as f64 / pixels.len() as f64;
    assert!(dark > 0.002 && dark < 0.3, "{dark}");
}

#[test]
fn a_narrow_page_keeps_the_size_of_its_text_and_takes_a_title() {
    let shape = arm().solve().unwrap();
    let heights = |svg: &str| -> Vec<String> {
        let sizes = svg.split("font-size=\"").skip(1).filter_map(|rest| rest.split('"').next());
        let mut sizes: Vec<String> = sizes.map(str::to_owned).collect();
        sizes.sort();
        sizes.dedup();
        sizes
    };
    let wide = arm_figure(&shape, None, &page());
    let column = Page { title: Some("A title".to_owned()), ..Page::of_width(0.085).unwrap() };
    let narrow = arm_figure(&shape, None, &column);
    assert!((narrow.size()[0] - 85.0 / 25.4 * 72.0).abs() < 1e-9);
    assert!(narrow.texts().any(|text| text == "A title") && !narrow.texts().any(|text| text == arm().name));
    assert_eq!(heights(&narrow.svg_with_text()), heights(&wide.svg_with_text()));
    let bare = reach_figure(&shape, &[], None, &Page { title: Some(String::new()), ..page() });
    assert!(!bare.texts().any(|text| text == arm().name) && bare.size()[1] < wide.size()[1]);
}

#[test]
fn text_is_written_as_text_on_request() {
    let svg = arm_figure(&arm().solve().unwrap(), None, &page()).svg_with_text();
    assert!(svg.contains(">two &lt;cables&gt; &amp; more</text>"), "{svg}");
    assert!(svg.contains("<tspan font-style=\"italic\">x</tspan> (mm)</text>"), "{svg}");
    assert!(svg.contains("transform=\"rotate(-90 ") && !svg.contains("aria-label"));
}

#[test]
fn arms_of_every_kind_can_be_drawn() {
    let mut bare = Arm::cone(0.1, 0.01, 0.01, 1e5, 0.5);
    arm_figure(&bare.solve().unwrap(), None, &page()).png().unwrap();
    bare.base.angle = 2.0;
    arm_figure(&bare.solve().unwrap(), None, &page()).png().unwrap();
    let mut many = bare.clone();
    for i in 0..12 {
        let name = format!("a cable with a rather long name, {i}");
        let cable = Cable::new(name, 0.0008 * f64::from(i - 6)).ending_at(0.5 + 0.04 * f64::from(i));
        many.cables.push(cable.pulled(0.1 * f64::from(i)));
    }
    let figure = arm_figure(&many.solve().unwrap(), None, &page());
    assert_eq!(figure.texts().filter(|t| t.contains("long name")).count(), 12);
    figure.png().unwrap();
}

/// A soft cone that the stream meets from the tip.
fn facing() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.flow.speed = 0.2;
    arm.flow.direction = std::f64::consts::PI;
    arm
}

#[test]
fn a_path_is_drawn_with_its_events_branches_and_end() {
    let over = Abscissa { name: "force".to_owned(), unit: "mN".to_owned(), per_si: 1e3 };
    let arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    let options = PathOptions { branches: true, ..PathOptions::default() };
    let path = arm.path(Parameter::TipForce(0), [0.0, -0.01], &options).unwrap();
    for quantity in [Quantity::TipX, Quantity::TipY, Quantity::TipTheta, Quantity::TipAlpha] {
        let figure = path_figure(&path, &over, quantity, "a column", &page());
        let texts: Vec<&str> = figure.texts().collect();
        for text in ["a column", "stable", "unstable", "bifurcation", "force (mN)"] {
            assert!(texts.contains(&text), "{text}: {texts:?}");
        }
        assert!(!texts.contains(&"limit point") && !figure.svg().contains("NaN"));
        figure.png().unwrap();
    }
    let shapes = path_shapes_figure(&path, &over, "a column", &page());
    // Bent to either side at the largest force, and straight.
    assert!(shapes.texts().filter(|text| *text == "\u{2212}10 mN").count() >= 2);
    shapes.png().unwrap();
}

#[test]
fn limits_are_marked_and_a_path_of_a_point_can_be_drawn() {
    let over = Abscissa { name: "tension".to_owned(), unit: "N".to_owned(), per_si: 1.0 };
    let mut arm = arm();
    arm.cables[0].tension = 0.0;
    let path = arm.path(Parameter::Tension(0), [0.0, 2.0], &PathOptions::default()).unwrap();
    let figure = path_figure(&path, &over, Quantity::Stroke(0), "pulled", &page());
    assert!(
        figure.texts().any(|t| t == "no equilibrium found beyond") && figure.texts().any(|t| t.contains("cable 0"))
    );
    let options = PathOptions { most: 1, ..PathOptions::default() };
    let short = arm.path(Parameter::Tension(0), [0.0, 2.0], &options).unwrap();
    assert_eq!(short.branches[0].points.len(), 1);
    for figure in
        [path_figure(&short, &over, Quantity::TipY, "", &page()), path_shapes_figure(&short, &over, "", &page())]
    {
        assert!(!figure.svg().contains("NaN") && !figure.svg().contains("inf"));
        figure.png().unwrap();
    }
}

#[test]
fn all_equilibria_are_drawn_and_numbered() {
    let all = facing().equilibria(1e-6).unwrap();
    let figure = equilibria_figure(&all, "facing", &page());
    let texts: Vec<&str> = figure.texts().collect();
    for text in ["facing", "1", "5", "stable", "unstable", "stream 0.2 m/s", "x (mm)"] {
        assert!(texts.contains(&text), "{text}: {texts:?}");
    }
    figure.png().unwrap();
    let over = Abscissa { name: "speed".to_owned(), unit: "m/s".to_owned(), per_si: 1.0 };
    let none: [(f64, &hydrostat::Equilibria); 0] = [];
    for searches in [&[(0.2, &all)][..], &[(0.1, &all), (0.2, &all)], &none] {
        let figure = over_figure(searches, &over, Quantity::TipTheta, "facing", &page());
        assert!(!figure.svg().contains("NaN") && figure.texts().any(|t| t == "speed (m/s)"));
        figure.png().unwrap();
    }
}

#[test]
fn the_study_finds_the_published_angle_and_judges_the_claims() {
    let study = Study::of(&source_arm(), &Shown::default()).unwrap();
    let angle = study.raised.last().unwrap().tip().alpha.to_degrees();
    assert!((angle - TIP_ANGLE).abs() <= 1e-6, "{angle}");
    assert!((study.highest_tension() - 86.24).abs() < 0.01, "{}", study.highest_tension());
    let tensions: Vec<f64> = study.raised.iter().map(|c| c.cables[0].tension).collect();
    assert_eq!(tensions[..5], [0.0, 5.0, 10.0, 20.0, 40.0]);
    assert!(study.faster.iter().all(|c| c.cables[0].tension == 40.0));
    let found: Vec<Finding> = study.claims.iter().map(|c| c.finding).collect();
    assert_eq!(found, [Holds, Holds, Holds, Holds, Holds, InPart, InPart, InPart, InPart, Open]);
    assert!(study.claims.iter().all(|c| !c.evidence.contains("NaN")));
    let figures = study.figures(&page());
    assert_eq!(figures.each_ref().map(|f| f.name), ["fig1a", "fig1b", "fig1c"]);
    assert!(figures[0].scene.texts().any(|t| t.ends_with("α(L) = 72.25°")));
    for figure in &figures {
        assert!(!figure.csv.contains("NaN") && !figure.scene.svg().contains("NaN"), "{}", figure.name);
    }
}

#[test]
fn a_study_needs_a_cable_and_a_tension_that_turns_the_tip() {
    let mut arm = source_arm();
    arm.cables[0].max_tension = Some(50.0);
    let Err(StudyError::NoTension { largest: 50.0, nearest: Some([tension, angle]) }) =
        Study::of(&arm, &Shown::default())
    else {
        panic!("50 N turn the tip by less");
    };
    assert!((tension - 50.0).abs() < 1e-6 && angle < 72.25 && angle > 60.0, "{tension} N, {angle} deg");
    for faster in [vec![], vec![0.5], vec![2.0, 1.0], vec![f64::NAN]] {
        let shown = Shown { faster, ..Shown::default() };
        assert!(matches!(Study::of(&arm, &shown), Err(StudyError::Faster { .. })), "{shown:?}");
    }
    arm.cables.clear();
    assert!(matches!(Study::of(&arm, &Shown::default()), Err(StudyError::NoCable { .. })));
}
