//! The page of a plan in a browser: what a user does is done by a script in a copy of the page, which writes what it saw into
//! the page; headless Chromium prints that. Skipped where there is no Chromium.

#![allow(clippy::print_stderr, reason = "what is skipped is said")]

mod common;

use common::{Run, command, hyperplan, text};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Where pages and their pictures are left, to be looked at.
fn folder(name: &str) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join("plan-page").join(name);
    fs::create_dir_all(&dir).expect("a folder that can be written");
    dir
}

fn chromium() -> Option<&'static str> {
    let found = ["chromium", "chromium-browser", "google-chrome"].into_iter().find(|name| {
        let mut command = Command::new(name);
        command.arg("--version").stdout(Stdio::null()).stderr(Stdio::null());
        command.status().is_ok_and(|status| status.success())
    });
    if found.is_none() {
        eprintln!("skipped: Chromium is missing");
    }
    found
}

/// What the browser prints on standard output and standard error. It has a profile of its own, and is ended where it hangs.
fn browse(chromium: &str, page: &Path, options: &[&str]) -> (String, String) {
    let profile = tempfile::tempdir().expect("a temporary folder");
    let file = |extension| fs::File::create(page.with_extension(extension)).expect("writable");
    let mut child = Command::new(chromium)
        .args([
            "--headless=new",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-dev-shm-usage",
            "--no-first-run",
        ])
        .args(["--hide-scrollbars", "--enable-logging=stderr", "--virtual-time-budget=4000"])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .args(options)
        .arg(format!("file://{}", page.display()))
        .stdin(Stdio::null())
        .stdout(file("out"))
        .stderr(file("err"))
        .spawn()
        .expect("the browser was there just now");
    let start = Instant::now();
    while child.try_wait().expect("a child can be waited for").is_none() {
        if start.elapsed() > Duration::from_secs(60) {
            child.kill().expect("a child can be ended");
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    let read = |extension| fs::read(page.with_extension(extension)).expect("what was written can be read");
    let text = |extension| String::from_utf8_lossy(&read(extension)).into_owned();
    (text("out"), text("err"))
}

/// The page of an objective of a file, and where it is.
fn page(name: &str, file: &str, objective: &str) -> (PathBuf, String) {
    let dir = folder(name);
    let (plan, page) = (dir.join("plan.json"), dir.join("plan.html"));
    let solved = hyperplan(&["solve", file, "--objective", objective, "--quiet", "--save", text(&plan)]);
    assert_eq!(solved.status, 0, "{}", solved.stderr);
    let drawn = hyperplan(&["plot", file, text(&plan), "-o", text(&page)]);
    assert_eq!((drawn.status, drawn.stdout.as_str(), drawn.stderr.as_str()), (0, "", ""));
    let made = fs::read_to_string(&page).expect("it was written");
    (page, made)
}

/// What a script saw that was run at the end of the page.
fn used(chromium: &str, (page, text): &(PathBuf, String), script: &str) -> String {
    let script = format!(
        r##"<script>
const seen = [];
window.addEventListener("error", event => seen.push(`error: ${{event.message}}`));
window.addEventListener("securitypolicyviolation", event => seen.push(`blocked: ${{event.blockedURI}}`));
const say = (what, value) => seen.push(`${{what}}: ${{value}}`);
const click = id => get(id).click();
const choose = (id, index) => {{ get(id).selectedIndex = index; get(id).dispatchEvent(new Event("change")); }};
const key = key => document.body.dispatchEvent(new KeyboardEvent("keydown", {{ key, bubbles: true, cancelable: true }}));
const robots = () => [...document.querySelectorAll("#picture .mover")].map(group => group.getAttribute("transform"));
const part = words => [...get("parts").tBodies[0].rows].find(row => row.cells[0].textContent === words);
{script}
const result = document.createElement("pre");
result.id = "seen";
result.textContent = seen.join("\n");
document.body.append(result);
</script>"##
    );
    let copy = page.with_file_name("used.html");
    fs::write(&copy, text.replace("</body>", &format!("{script}</body>"))).expect("writable");
    let (dom, errors) = browse(chromium, &copy, &["--dump-dom"]);
    assert!(!errors.contains("CONSOLE"), "{errors}");
    let seen = dom.split_once("<pre id=\"seen\">").and_then(|(_, rest)| rest.split_once("</pre>"));
    let (seen, _) = seen.unwrap_or_else(|| panic!("the script did not get to its end: {errors}"));
    seen.replace("&gt;", ">").replace("&lt;", "<").replace("&amp;", "&")
}

#[test]
fn time_goes_by_slider_buttons_and_keys() {
    let Some(chromium) = chromium() else { return };
    let made = page("isr", "rooms.hp", "isr");
    let seen = used(
        chromium,
        &made,
        r##"
say("robots", robots().length);
const before = robots().join();
say("now", get("now").textContent);
click("on");
say("on", get("now").textContent);
say("moved", robots().join() !== before);
click("back");
say("back", robots().join() === before);
key("ArrowRight"); key("ArrowRight");
say("keys", get("now").textContent);
key("End");
say("end", get("now").textContent);
say("here", get("states").querySelectorAll("tr.here").length + " " + get("states").querySelector("tr.here").cells[0].textContent);
key("Home");
slider.value = 3; slider.dispatchEvent(new Event("input"));
say("slider", get("now").textContent + ", " + slider.getAttribute("aria-valuetext"));
say("said", get("said").textContent.startsWith("Time 3 of 6. p: action"));
click("play");
say("plays", play.textContent + " " + play.getAttribute("aria-pressed"));
click("play");
say("stopped", play.textContent);
choose("view", 1);
say("side by side", document.querySelectorAll("#picture svg").length + " " + [...document.querySelectorAll("#picture figcaption")].map(c => c.textContent).join());
choose("view", 0);
say("rows", get("states").tBodies[0].rows.length);
const goal = part("F[0,6] goal[p]");
say("part", goal.cells[2].textContent.replace(/\d+$/, "T"));
key("Home");
say("open", goal.cells[1].textContent);
key("End");
say("holds", goal.cells[1].textContent);
const entries = [...get("variant").options].map(o => o.textContent);
say("menu", entries[0] + "; " + entries.filter(e => e.startsWith("q from")).join("; "));
choose("variant", entries.findIndex(e => e.startsWith("q from (x = 1")));
say("start of q", variant.paths[1].rows[0].slice(1, 3).join());
say("areas", document.querySelectorAll("#picture .areas path").length > 0);
say("unnamed", [...document.querySelectorAll("button, select, input, svg, .wide")].filter(element =>
  !element.textContent.trim() && !element.labels?.length && !element.getAttribute("aria-label") && !element.getAttribute("aria-labelledby")).length);
say("wide", document.documentElement.scrollWidth > window.innerWidth);
"##,
    );
    let expected = "\
robots: 2
now: 0 of 6
on: 1 of 6
moved: true
back: true
keys: 2 of 6
end: 6 of 6
here: 1 6
slider: 3 of 6, time 3 of 6
said: true
plays: Stop true
stopped: Play
side by side: 2 p,q
rows: 7
part: holds, decided at time T
open: ? open
holds: ✓ holds
menu: the worst of all; q from (x = 0, y = 0); q from (x = 1, y = 0)
start of q: 1,0
areas: true
unnamed: 0
wide: false";
    assert_eq!(seen, expected);
}

#[test]
fn replaced_actions_have_entries() {
    let (_, made) = page("ar", "rooms.hp", "ar");
    let options = made.matches("<option>q, step ").count();
    assert!(options >= 3, "{options}");
    assert!(made.contains("<option>the worst of all</option>") && made.contains(" instead of "));
}

#[test]
fn an_observer_is_there() {
    let Some(chromium) = chromium() else { return };
    let made = page("cso", "rooms.hp", "cso");
    let seen = used(
        chromium,
        &made,
        r##"
say("columns", [...get("states").tHead.rows[0].cells].map(c => c.textContent).join("|"));
say("same", variant.same.every(same => same));
say("said", /The observer sees the same of all paths\.$/.test(get("said").textContent));
say("menu", get("variant") === null);
"##,
    );
    let expected = "\
columns: time|p: action|p: x|p: y|p: observer sees|q: action|q: x|q: y|q: observer sees
same: true
said: true
menu: true";
    assert_eq!(seen, expected);
}

#[test]
fn light_dark_and_printed() {
    let Some(chromium) = chromium() else { return };
    let (page, _) = page("looks", "case-studies/isr-10.hp", "isr");
    for (name, theme) in [("light.png", "1"), ("dark.png", "0")] {
        let picture = page.with_file_name(name);
        let options = [
            format!("--screenshot={}", picture.display()),
            "--window-size=1200,1600".to_owned(),
            format!("--blink-settings=preferredColorScheme={theme}"),
        ];
        let (_, errors) = browse(chromium, &page, &options.each_ref().map(String::as_str));
        assert!(!errors.contains("CONSOLE"), "{name}: {errors}");
        let bytes = fs::read(&picture).expect("a screenshot was taken");
        assert!(bytes.starts_with(b"\x89PNG") && bytes.len() > 20_000, "{name}: {} bytes", bytes.len());
    }
}

/// Without any browser: nothing of a problem gets into the page as markup, nothing is fetched.
#[test]
fn nothing_escapes() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let (file, plan, page) =
        (dir.path().join("p.hp"), dir.path().join("plan.json"), dir.path().join("p.html"));
    let nasty = "</script><img src=x onerror=alert(1)>";
    let problem = format!(
        "system L {{ state door: {{ \"{nasty}\", open }}; action push; init door == \"{nasty}\"; on push {{ door' = open; }} }}
         objective o {{ exists p. F[0,2] door[p] == open }}"
    );
    fs::write(&file, problem).expect("ours");
    let run = |arguments: &[&str]| Run::new(command(arguments).output().expect("the command was built"));
    let solved = run(&["solve", text(&file), "--quiet", "--save", text(&plan)]);
    assert_eq!(solved.status, 0, "{}", solved.stderr);
    let drawn = run(&["plot", text(&file), text(&plan), "-o", text(&page)]);
    assert_eq!(drawn.status, 0, "{}", drawn.stderr);
    let made = fs::read_to_string(&page).expect("it was written");
    assert!(made.contains("\\u003c/script>") && !made.contains("<img"), "{made}");
    assert_eq!(made.matches("</script>").count(), 2);
    let elsewhere = ["src=\"", "@import", "fetch(", "XMLHttp", "href=\"http"];
    assert!(!elsewhere.iter().any(|way| made.contains(way)));
}
