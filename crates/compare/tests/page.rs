//! The page in a browser: what a user does is done by a script in a copy of the page, which writes what it saw into the page;
//! headless Chromium prints that. Skipped where there is no Chromium.

#![allow(clippy::print_stderr, reason = "what is skipped is said")]

mod sample;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use hyperplan_compare::Record;
use hyperplan_compare::report::{write_all, write_all_from};
use sample::{run, sample};

/// Where the page and its pictures are left, to be looked at.
fn folder(name: &str) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
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

/// Runs the browser with a profile of its own. It is known to hang at its end now and then; it is ended then, and what it
/// wrote is looked at.
fn browse(chromium: &str, page: &Path, options: &[&str]) -> Output {
    let profile = tempfile::tempdir().expect("a temporary folder");
    let mut child = Command::new(chromium)
        .args([
            "--headless=new",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-dev-shm-usage",
            "--hide-scrollbars",
        ])
        .args(["--no-first-run", "--enable-logging=stderr", "--virtual-time-budget=3000"])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .args(options)
        .arg(format!("file://{}", page.display()))
        .stdin(Stdio::null())
        .stdout(fs::File::create(page.with_extension("out")).expect("a file that can be written"))
        .stderr(fs::File::create(page.with_extension("err")).expect("a file that can be written"))
        .spawn()
        .expect("the browser was there just now");
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().expect("a child can be waited for") {
            break status;
        }
        if start.elapsed() > Duration::from_secs(60) {
            child.kill().expect("a child can be ended");
            break child.wait().expect("a child can be waited for");
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    let read = |extension| fs::read(page.with_extension(extension)).expect("what was written can be read");
    Output { status, stdout: read("out"), stderr: read("err") }
}

const USE: &str = r##"
<script>
const seen = [];
window.addEventListener("error", event => seen.push(`error: ${event.message}`));
window.addEventListener("securitypolicyviolation", event => seen.push(`blocked: ${event.blockedURI}`));
const column = (id, i) => [...document.getElementById(id).tBodies[0].rows].map(row => row.cells[i].textContent);
const head = (id, i) => document.getElementById(id).tHead.rows[0].cells[i];
const press = (id, i) => { const button = head(id, i).querySelector("button"); button.focus(); button.click(); };
const say = (what, value) => seen.push(`${what}: ${value}`);
say("solved", column("scores", 4).join(","));
press("scores", 4);
say("ascending", column("scores", 4).join(","));
say("aria", head("scores", 4).getAttribute("aria-sort"));
press("scores", 4);
say("descending", column("scores", 4).join(","));
press("scores", 1);
say("names", column("scores", 1).join(","));
say("left", head("scores", 4).getAttribute("aria-sort"));
press("instances", 3);
say("times", column("instances", 3).join(","));
say("focus", document.activeElement.textContent);
const select = document.getElementById("scatter-y");
say("marks", document.querySelectorAll("#scatter .points path").length);
select.selectedIndex = select.options.length - 1;
select.dispatchEvent(new Event("change"));
say("other marks", document.querySelectorAll("#scatter .points path").length);
say("axis", document.querySelectorAll("#scatter .name")[1].textContent);
const filter = document.getElementById("filter");
filter.value = "ar-20 timeout";
filter.dispatchEvent(new Event("input"));
say("filtered", document.getElementById("filter-count").textContent);
say("scripts", document.querySelectorAll("script").length);
say("unnamed", [...document.querySelectorAll("button, select, input, svg, .wide")].filter(element =>
  !element.textContent.trim() && !element.labels?.length && !element.getAttribute("aria-label")).length);
say("wide", document.documentElement.scrollWidth > window.innerWidth);
const result = document.createElement("pre");
result.id = "seen";
result.textContent = seen.join("\n");
document.body.append(result);
</script>
"##;

#[test]
fn used_in_a_browser() {
    let Some(chromium) = chromium() else { return };
    let dir = folder("page");
    write_all(&sample(), &dir).expect("a folder that can be written");
    let page = fs::read_to_string(dir.join("report.html")).expect("what was written can be read");
    let used = dir.join("used.html");
    fs::write(&used, page.replace("</body>", &format!("{USE}</body>"))).expect("a file that can be written");
    let output = browse(chromium, &used, &["--dump-dom"]);
    let dom = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    let seen = dom.split_once("<pre id=\"seen\">").and_then(|(_, rest)| rest.split_once("</pre>"));
    let (seen, _) = seen.unwrap_or_else(|| panic!("the script did not get to its end: {errors}"));
    assert!(!errors.contains("CONSOLE"), "{errors}");
    let expected = "\
solved: 7,7,6,3,8
ascending: 3,6,7,7,8
aria: ascending
descending: 7,7,6,3,8
names: builtin auto,cvc5 auto,z3 expand,z3 keep,virtual best
left: null
times: 0.050,0.200,0.200,0.200,0.300,0.500,1.500,unsupported
focus: z3 expand
marks: 7
other marks: 7
axis: z3 keep, seconds
filtered: 1 of 8
scripts: 3
unnamed: 0
wide: false";
    assert_eq!(seen, expected);
}

#[test]
fn pictures() {
    let Some(chromium) = chromium() else { return };
    let dir = folder("pictures");
    let records = large();
    write_all_from(&records, &dir, "..").expect("a folder that can be written");
    let page = dir.join("report.html");
    for (name, theme) in [("light.png", "1"), ("dark.png", "0")] {
        let picture = dir.join(name);
        let options = [
            format!("--screenshot={}", picture.display()),
            "--window-size=1200,2600".to_owned(),
            format!("--blink-settings=preferredColorScheme={theme}"),
        ];
        let output = browse(chromium, &page, &options.each_ref().map(String::as_str));
        assert!(!String::from_utf8_lossy(&output.stderr).contains("CONSOLE"), "{name}");
        let bytes = fs::read(&picture).expect("a screenshot was taken");
        assert!(bytes.starts_with(b"\x89PNG") && bytes.len() > 20_000, "{name}: {} bytes", bytes.len());
    }
    let paper = dir.join("print.pdf");
    let option = format!("--print-to-pdf={}", paper.display());
    browse(chromium, &page, &[&option, "--no-pdf-header-footer"]);
    assert!(fs::read(&paper).expect("the page was printed").starts_with(b"%PDF"));
    heads_are_on_every_page(&paper);
}

/// What is on paper, by `pdftotext`, where there is one: each page with instances has the names of the columns.
fn heads_are_on_every_page(paper: &Path) {
    let Ok(output) = Command::new("pdftotext").arg("-layout").arg(paper).arg("-").output() else {
        eprintln!("skipped: pdftotext is missing");
        return;
    };
    let text = String::from_utf8_lossy(&output.stdout);
    let with_instances: Vec<&str> = text.split('\u{c}').filter(|page| page.contains(".hp#reach")).collect();
    assert!(with_instances.len() > 1, "{text}");
    for page in with_instances {
        assert!(page.contains("instance ") && page.contains("answer "), "{page}");
    }
}

/// The sample again, and many more instances on which times spread.
fn large() -> Vec<Record> {
    use hyperplan_compare::RunStatus::{Sat, Timeout, Unsat};
    let mut records = sample();
    for i in 0..60_u32 {
        for (c, (solver, quantifiers)) in
            (0_u32..).zip([("builtin", "auto"), ("cvc5", "auto"), ("z3", "expand"), ("z3", "keep")])
        {
            let spread = f64::from((i * 37 + c * c * 11 + i * i * c) % 50) / 12.0;
            let wall = 0.003 * f64::from(c + 1) * 10.0_f64.powf(spread * 0.9);
            let status = if wall > 10.0 {
                Timeout
            } else if i % 3 == 0 {
                Unsat
            } else {
                Sat
            };
            let mut record = run(solver, &format!("specs/grid/{i:02}.hp#reach"), status, wall.min(10.0));
            record.family = "specs/grid".to_owned();
            record.quantifiers = Some(quantifiers.to_owned());
            records.push(record);
        }
    }
    records
}

/// Without any browser: nothing of a record gets into the page as markup, nothing is fetched.
#[test]
fn nothing_escapes() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let nasty = "</script><img src=x onerror=alert(1)>\"'&javascript:alert(1)";
    let mut records = sample();
    for record in &mut records {
        for text in [
            &mut record.instance,
            &mut record.family,
            &mut record.solver,
            &mut record.options,
            &mut record.host,
        ] {
            text.push_str(nasty);
        }
        record.set.push(nasty.to_owned());
        record.version = Some(nasty.to_owned());
        record.message = Some(nasty.to_owned());
        record.verified = Some(nasty.to_owned());
        record.queries = Some("javascript:alert(1)//\"".to_owned());
    }
    write_all(&records, dir.path()).expect("a folder that can be written");
    for entry in fs::read_dir(dir.path()).expect("the folder is there") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|extension| extension == "html" || extension == "svg") {
            let text = fs::read_to_string(&path).expect("what was written can be read");
            assert!(!text.contains("<img"), "{}", path.display());
            assert!(!text.contains("href=\"javascript"), "{}", path.display());
            let elsewhere = ["src=\"", "url(", "@import", "fetch("];
            assert!(!elsewhere.iter().any(|way| text.contains(way)), "{}", path.display());
            let scripts = text.matches("</script>").count();
            assert!(scripts == 0 || scripts == 2, "{}", path.display());
        }
    }
}
