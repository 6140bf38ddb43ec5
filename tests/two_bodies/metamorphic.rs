//! What must not change an answer does not: random scenes with the sides of their pairs exchanged, far from the origin,
//! turned, in other units, with bodies, nodes and cells in another order or of another kind, with loads and surfaces in
//! parts, with whole skins as contact surfaces, and under less load.

use dpana::verify::metamorphic;

#[test]
fn what_must_not_change_an_answer_does_not() {
    let battery = metamorphic(1, 230, |_| ()).unwrap();
    assert!(battery.pairs() >= 2000, "{}", battery.summary());
    assert!(battery.passed, "{}{:#?}", battery.summary(), battery.wrong);
}
