use ::svg::parser::Event;

use super::super::tests::map;
use super::*;

/// Names and attributes of all opening and empty tags, after a check that the text is well-formed.
fn tags(text: &str) -> Vec<(String, ::svg::node::Attributes)> {
    use ::svg::node::element::tag::Type;
    let mut open = Vec::new();
    let mut tags = Vec::new();
    for event in ::svg::read(text).unwrap() {
        match event {
            Event::Tag(name, Type::Start, attributes) => {
                open.push(name.to_owned());
                tags.push((name.to_owned(), attributes));
            }
            Event::Tag(name, Type::Empty, attributes) => tags.push((name.to_owned(), attributes)),
            Event::Tag(name, Type::End, _) => assert_eq!(open.pop().as_deref(), Some(name)),
            Event::Error(error) => panic!("{error}"),
            _ => {}
        }
    }
    assert!(open.is_empty());
    tags
}

fn draw(map: &GlobalMap) -> String {
    svg(map, &SvgParams::default()).unwrap()
}

/// A sunflower of landmarks in regions of about 40.
fn sunflower(n: u32) -> GlobalMap {
    let ids: Vec<String> = (0..n).map(|i| format!("L{i}")).collect();
    let rows: Vec<_> = (0..n)
        .map(|i| {
            let (r, a) = (f64::from(i).sqrt(), 2.4 * f64::from(i));
            (ids[i as usize].as_str(), [r * a.cos(), r * a.sin()], 0, i / 40)
        })
        .collect();
    map(&rows)
}

/// The numbers of an attribute over all tags of a name.
fn numbers(tags: &[(String, ::svg::node::Attributes)], name: &str, attribute: &str) -> Vec<f64> {
    let named = tags.iter().filter(|tag| tag.0 == name);
    named.filter_map(|tag| tag.1.get(attribute)).map(|value| value.parse().unwrap()).collect()
}

#[test]
fn small_maps_show_dots_ids_edges_and_regions() {
    let text = draw(&sunflower(60));
    let tags = tags(&text);
    // The legend has two more dots, for two regions.
    assert_eq!(numbers(&tags, "circle", "cx").len(), 62);
    assert!((0..60).all(|i| text.contains(&format!(">\nL{i}\n<"))));
    assert_eq!(text.matches("<title>").count(), 60);
    let [width, height] = [numbers(&tags, "svg", "width")[0], numbers(&tags, "svg", "height")[0]];
    assert!(numbers(&tags, "circle", "cx").iter().all(|&x| x > 0.0 && x < width));
    assert!(numbers(&tags, "circle", "cy").iter().all(|&y| y > -5.0 && y < height));
    assert!(text.contains("60 landmarks") && text.contains("Delaunay edge"));
}

#[test]
fn large_maps_are_drawn_with_few_elements() {
    let middle = draw(&sunflower(1000));
    assert!(!middle.contains(">\nL7\n<") && middle.contains("L7 · region 0"));
    let large = draw(&sunflower(2500));
    assert!(tags(&large).len() < 150, "{}", tags(&large).len());
    assert_eq!(large.matches("h0").count(), 2500);
}

#[test]
fn the_smallest_maps_and_all_in_one_place_are_drawn() {
    for n in 0..4 {
        let text = draw(&sunflower(n));
        assert!(!text.contains("NaN") && !text.contains("inf"), "{n}");
        assert_eq!(tags(&text).iter().filter(|tag| tag.0 == "circle").count() as u32, n + 1);
    }
    let one_place = map(&[("a", [2.0, 2.0], 0, 0), ("b", [2.0, 2.0], 0, 0), ("c", [2.0, 2.0], 0, 0)]);
    assert!(!draw(&one_place).contains("NaN"));
    let huge = map(&[("a", [1.7e308, 0.0], 0, 0), ("b", [-1.7e308, 1e-300], 0, 0)]);
    assert!(!draw(&huge).contains("NaN") && !draw(&huge).contains("inf"));
}

#[test]
fn hostile_ids_stay_text() {
    let long = "x".repeat(10_000);
    let text = draw(&map(&[
        ("</svg><script>", [0.0, 0.0], 0, 0),
        ("\u{1}\u{b}", [1.0, 0.0], 0, 0),
        (&long, [2.0, 0.0], 0, 0),
    ]));
    tags(&text);
    assert!(!text.contains("<script>") && text.contains("&lt;/svg&gt;&lt;script&gt;"));
    assert!(text.contains("\u{fffd}\u{fffd}") && !text.contains('\u{1}'));
    assert!(text.contains("xxxxxxxxxxxxxxxxxx…"));
}

#[test]
fn components_have_captions_and_the_smallest_of_very_many_are_counted() {
    let ids: Vec<String> = (0..130).map(|i| i.to_string()).collect();
    let rows = |n: usize| ids[..n].iter().zip(0..).map(|(id, i)| (id.as_str(), [f64::from(i), 0.0], i, 0));
    let few = draw(&map(&rows(3).collect::<Vec<_>>()));
    assert!((0..3).all(|i| few.contains(&format!("component {i} · 1 landmark\n<"))));
    let many = draw(&map(&rows(130).collect::<Vec<_>>()));
    assert!(many.contains("130 components") && many.contains("30 more components not drawn"));
    assert_eq!(many.matches("· 1 landmark\n<").count(), 12);
}

#[test]
fn the_truth_gives_the_frame_and_rings_beside_their_landmarks() {
    // The map is the truth mirrored, halved and turned; D is a little off, E not surveyed.
    let surveyed = "id,x,y\nA,0,0\nB,10,0\nC,10,6\nD,0,6\nF,5,5\n";
    let turned = |x: f64, y: f64| [0.5 * y, 0.5 * x];
    let map = map(&[
        ("A", turned(0.0, 0.0), 0, 0),
        ("B", turned(10.0, 0.0), 0, 0),
        ("C", turned(10.0, 6.0), 0, 0),
        ("D", turned(0.0, 7.0), 0, 0),
        ("E", turned(5.0, 3.0), 0, 0),
        ("lone", [0.0, 0.0], 1, 1),
    ]);
    let truth = Truth::parse(surveyed.as_bytes(), "truth.csv").unwrap();
    let params = SvgParams { title: Some("Side by side".to_owned()), truth: Some(&truth) };
    let text = svg(&map, &params).unwrap();
    let tags = tags(&text);
    assert!(text.contains("Side by side") && text.contains("surveyed position"));
    // Landmarks, four rings, and in the legend two dots and a ring.
    let (x, y) = (numbers(&tags, "circle", "cx"), numbers(&tags, "circle", "cy"));
    assert_eq!(x.len(), 6 + 4 + 3);
    let [a, b, d] = [0, 1, 3].map(|i| [x[i], y[i]]);
    let ring_of_a = [x[6], y[6]];
    let width = (a[0] - b[0]).hypot(a[1] - b[1]);
    assert!((a[0] - ring_of_a[0]).hypot(a[1] - ring_of_a[1]) < 0.08 * width);
    // The right way round: B right of A, D above A.
    assert!(b[0] > a[0] + 100.0 && d[1] < a[1] - 100.0);
    let strangers = Truth::parse(b"id,x,y\nQ,0,0\n", "truth.csv").unwrap();
    let refused = svg(&map, &SvgParams { truth: Some(&strangers), ..SvgParams::default() });
    assert!(matches!(refused, Err(MapError::NoCommonLandmarks { .. })));
}

#[test]
fn the_same_map_gives_the_same_bytes() {
    assert_eq!(draw(&sunflower(150)), draw(&sunflower(150)));
    assert_eq!(draw(&sunflower(3000)), draw(&sunflower(3000)));
}

#[test]
fn counts_have_spaces_between_thousands() {
    let words = [0, 1, 999, 1000, 1_234_567].map(|count| counted(count, "step"));
    assert_eq!(
        words,
        ["0 steps", "1 step", "999 steps", "1\u{202f}000 steps", "1\u{202f}234\u{202f}567 steps"]
    );
}
