// When a foot counts as standing, by its vertical force: shares of the weight, and times.
#include "online/contact_gate.hpp"

#include "check.hpp"

namespace contact_gate_test {

using namespace plantar;

constexpr double WEIGHT = 500.0, PERIOD = 0.001;  // N, s

// The state after `seconds` of one load [N].
ContactState after(ContactGate& gate, double load, double seconds) {
  for (int tick = 0; tick < static_cast<int>(seconds / PERIOD + 0.5); ++tick) gate.step(load, 0.0, true, true, PERIOD);
  return gate.contact();
}

void a_foot_that_stands_from_the_first_reading_lands_with_it() {
  ContactGate gate(WEIGHT, false);
  check::that(gate.step(150.0, 0.0, true, true, PERIOD) == ContactState::landing, "landed with the first reading");
  check::that(after(gate, 150.0, 0.24) == ContactState::landing, "not settled yet");
  check::that(after(gate, 150.0, 0.02) == ContactState::stance, "settled after a quarter of a second");
}

void between_both_shares_it_stays_what_it_was() {
  ContactGate gate(WEIGHT, false);
  check::that(after(gate, 0.09 * WEIGHT, 1.0) == ContactState::air, "less than a tenth of the weight");
  check::that(after(gate, 0.11 * WEIGHT, 1.0) == ContactState::stance, "more than a tenth");
  check::that(after(gate, 0.06 * WEIGHT, 1.0) == ContactState::stance, "more than a twentieth");
  check::that(after(gate, 0.04 * WEIGHT, 1.0) == ContactState::air, "less than a twentieth");
  check::that(gate.stances() == 1, "one stance so far");
}

void a_foot_that_always_stands_stands_from_the_first_reading() {
  ContactGate gate(WEIGHT, true);
  check::that(gate.step(0.0, WEIGHT, false, false, PERIOD) == ContactState::stance, "whatever its sensor reads");
}

void a_sole_that_does_not_lie_flat_still_lands() {
  ContactGate gate(WEIGHT, false);
  for (int tick = 0; tick < 1000; ++tick) gate.step(0.5 * WEIGHT, 0.0, false, true, PERIOD);
  check::that(gate.contact() == ContactState::landing, "on its edge");
  check::that(gate.step(0.5 * WEIGHT, 0.0, true, true, PERIOD) == ContactState::stance, "flat at last");
}

void a_foot_that_only_touched_has_not_stood() {
  ContactGate gate(WEIGHT, false);
  for (int step = 0; step < 5; ++step) after(gate, 300.0, 0.1), after(gate, 0.0, 0.4);
  check::that(gate.stances() == 0, "no stance");
  check::near(gate.settling(), 0.25, 1e-9, "and none that is usual");
  check::near(gate.standing_for(), 0.0, 0.0, "in the air");
}

void a_blow_of_a_tick_is_no_landing() {
  ContactGate gate(WEIGHT, false);
  after(gate, 0.0, 0.1);
  check::that(after(gate, 0.4 * WEIGHT, PERIOD) == ContactState::air, "40 Hz pass a quarter of it");
  check::that(after(gate, 0.0, 0.1) == ContactState::air, "gone again");
}

void missing_readings_are_forgotten_with_what_was_before_them() {
  ContactGate gate(WEIGHT, false);
  after(gate, 300.0, 1.0);
  gate.restart();
  check::that(gate.contact() == ContactState::landing, "old: it has to settle anew");
  check::that(gate.step(0.0, 0.0, true, true, PERIOD) == ContactState::air, "the next reading alone tells");
}

void short_stances_settle_sooner() {
  ContactGate gate(WEIGHT, false);
  for (int step = 0; step < 40; ++step) after(gate, 300.0, 0.6), after(gate, 0.0, 0.4);
  check::near(gate.settling(), 0.06, 0.002, "a tenth of a usual stance");
  for (int step = 0; step < 40; ++step) after(gate, 300.0, 5.0), after(gate, 0.0, 0.4);
  check::near(gate.settling(), 0.25, 1e-9, "a quarter of a second at most");
}

// By three tenths of what it was off.
void one_stance_changes_what_is_usual() {
  ContactGate gate(WEIGHT, false);
  double usual = FIRST_STANCE;
  for (int step = 0; step < 4; ++step) {
    after(gate, 300.0, 0.6), after(gate, 0.0, 0.4);
    usual = 0.7 * usual + 0.3 * 0.6;
    check::near(gate.settling(), 0.1 * usual, 2e-3, "a tenth of what is usual by now");
  }
}

// Its zero may be off: a foot that reads little while others carry the robot is in the air.
void a_foot_without_a_zero_lifts_where_others_carry() {
  const auto lifts = [](double load, double others, double seconds, bool known) {
    ContactGate gate(WEIGHT, false);
    after(gate, 0.5 * WEIGHT, 1.0);
    for (int tick = 0; tick < static_cast<int>(seconds / PERIOD); ++tick)
      gate.step(load * WEIGHT, others * WEIGHT, true, known, PERIOD);
    return gate.contact() == ContactState::air;
  };
  check::that(lifts(0.15, 0.75, 0.15, false), "a tenth of a second and the filter's time");
  check::that(!lifts(0.15, 0.75, 0.1, false), "sooner it may be a blow");
  check::that(!lifts(0.15, 0.75, 0.5, true), "its zero is known");
  check::that(!lifts(0.15, 0.65, 0.5, false), "others carry less");
  check::that(!lifts(0.25, 0.75, 0.5, false), "it reads more");
  ContactGate gate(WEIGHT, false);
  for (int tick = 0; tick < 500; ++tick) gate.step(0.15 * WEIGHT, 0.75 * WEIGHT, true, false, PERIOD);
  check::that(gate.contact() == ContactState::air, "nor does it land so");
  ContactGate twice(WEIGHT, false);
  after(twice, 0.5 * WEIGHT, 1.0);
  for (int tick = 0; tick < 300; ++tick)
    twice.step((tick / 75 % 2 ? 0.5 : 0.15) * WEIGHT, 0.75 * WEIGHT, true, false, PERIOD);
  check::that(twice.contact() == ContactState::stance, "two that are short are none that is long");
}

void run() {
  a_foot_that_always_stands_stands_from_the_first_reading();
  a_sole_that_does_not_lie_flat_still_lands();
  a_foot_that_only_touched_has_not_stood();
  one_stance_changes_what_is_usual();
  a_foot_without_a_zero_lifts_where_others_carry();
  a_foot_that_stands_from_the_first_reading_lands_with_it();
  between_both_shares_it_stays_what_it_was();
  a_blow_of_a_tick_is_no_landing();
  missing_readings_are_forgotten_with_what_was_before_them();
  short_stances_settle_sooner();
}

const check::Listed listed(run);

}  // namespace contact_gate_test
