# SPDX-License-Identifier: BSD-3-Clause
library(mmbrdf)
ptfe <- material("ptfe")
show <- function(name, numbers) cat(name, sprintf("%.17g", numbers), "\n")
for (q in 0:2) {
  g <- list(ptfe, 532, 20 + 30 * q, 10, 70 - 30 * q, 100)
  show("matrix", t(do.call(evaluate, c(g, frame = "sp", convention = "p_first_right"))[, , 1]))
  show("uncertainty", t(do.call(evaluate_uncertainty, c(g, frame = "sp"))[, , 1]))
  show("depolarization", unlist(do.call(analyze, c(g, names = "depolarization"))))
  show("dhr", unlist(dhr(ptfe, 532, 20 + 30 * q, 10)))
  show("outside", do.call(outside, g))
}
