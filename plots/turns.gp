# followed(phase, starts): a phase by whole turns from the start of its branch, over pi, so that it does not jump at the
# ends of (-pi, pi].

last_phase = 0
nearest_turn(phase) = 2 * pi * floor(phase / (2 * pi) + 0.5)
followed(phase, starts) = (phase == phase ? \
  (last_phase = starts ? (phase < -pi / 2 ? phase + 2 * pi : phase) : phase - nearest_turn(phase - last_phase)) : NaN) / pi
