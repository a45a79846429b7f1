use super::ok;
use crate::{Value, display};

#[test]
fn states_and_values() {
    let text = r#"system W = grid { "..." edge crash; label far = !(x in {0, 1}) | x - y > 0 - 1 & !crash; }
        system M { state mode: {idle, busy}, n: 0..3; label l = mode != busy & (n + 1) * 2 <= 4; }"#;
    let problem = ok(text).problem;
    let (w, m) = (problem.systems.first().expect("W"), problem.systems.last().expect("M"));
    let state = |crash| vec![Value::Int(1), Value::Int(0), Value::Bool(crash)].into_boxed_slice();
    assert_eq!(display::state(w, &state(false)), "(x = 1, y = 0)");
    assert_eq!(display::state(w, &state(true)), "(x = 1, y = 0, crash = true)");
    assert_eq!(
        display::state(m, &vec![Value::Enum(1), Value::Int(3)].into_boxed_slice()),
        "(mode = busy, n = 3)"
    );
    let far = w.labels.first().expect("a label");
    assert_eq!(display::state_expr(w, &far.expr), "!(x == 0 | x == 1) | -1 < x - y & !crash");
    let l = m.labels.first().expect("a label");
    assert_eq!(display::state_expr(m, &l.expr), "mode != busy & 2 * (n + 1) <= 4");
}
