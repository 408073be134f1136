# SPDX-License-Identifier: BSD-3-Clause
library(mmbrdf)

refused <- function(expression, message) {
  said <- tryCatch({ expression; "nothing" }, error = conditionMessage)
  if (!grepl(message, said, fixed = TRUE)) stop("expected '", message, "', was told '", said, "'")
}

ptfe <- material("ptfe")
theta <- c(0, 10, 30, 60)
f <- evaluate(ptfe, 532, 45, 0, theta, 180, frame = "sp")
stopifnot(identical(dim(f), c(4L, 4L, 4L)), !anyNA(f))

# A vector is its elements, one by one.
for (q in 1:4) stopifnot(identical(f[, , q], evaluate(ptfe, 532, 45, 0, theta[q], 180, frame = "sp")[, , 1]))

many <- seq(0, 80, length.out = 70000)   # in pieces, on all cores
stopifnot(identical(evaluate(ptfe, 532, 45, 0, many, 180)[, , 69999], evaluate(ptfe, 532, 45, 0, many[69999], 180)[, , 1]))

# Reciprocity: source and detector exchanged transpose the matrix and turn the sign of 13, 23, 34 and their transposes.
signs <- outer(c(1, 1, -1, 1), c(1, 1, -1, 1))
exchanged <- evaluate(ptfe, 532, 60, 180, 45, 0, frame = "sp")[, , 1]
stopifnot(all.equal(f[, , 4], signs * t(exchanged), tolerance = 1e-12))

# Wavelengths in any order are those of one call each.
w <- c(633, 351, 633, 532)
several <- evaluate(ptfe, w, 45, 0, theta, 180)
for (q in 1:4) stopifnot(identical(several[, , q], evaluate(ptfe, w[q], 45, 0, theta[q], 180)[, , 1]))
stopifnot(identical(outside(ptfe, w, 45, 0, c(theta[1:3], 89), 180), c(0L, 0L, 0L, 2L)))

# A data frame has what the arrays have.
newdata <- data.frame(wavelength_nm = w, theta_i_deg = 45, phi_i_deg = 0, theta_r_deg = theta, phi_r_deg = 180)
rows <- predict(ptfe, newdata)
stopifnot(identical(rows$f12, several[1, 2, ]), identical(rows$f43, several[4, 3, ]),
          identical(rows$u_f21, evaluate_uncertainty(ptfe, w, 45, 0, theta, 180)[2, 1, ]),
          nrow(predict(ptfe, newdata[0, ])) == 0)

q <- analyze(ptfe, w, 45, 0, theta, 180, names = c("f_ss", "depolarization"))
stopifnot(identical(names(q), c("f_ss", "depolarization", "u_f_ss", "u_depolarization")),
          all(q$f_ss > 0), all(q$u_f_ss > 0),
          ncol(analyze(ptfe, 532, 45, 0, 30, 180)) == 2 * nrow(quantities()))

reflectance <- dhr(ptfe, 532, c(8, 45))
stopifnot(all(reflectance$dhr > 0.9), all(reflectance$u_dhr > 0))

# Of a model without a covariance no uncertainty is known: NA, not NaN.
published <- tempfile(fileext = ".csv")
writeLines("1,1,0,0,0,0,0,1", published)
plain <- load_model(published)
u <- evaluate_uncertainty(plain, 532, 45, 0, theta, 180)
stopifnot(all(is.na(u)), !any(is.nan(u)))

stopifnot(identical(dim(evaluate(ptfe, 532, numeric(), 0, 30, 180)), c(4L, 4L, 0L)), all(known_elements(ptfe)))
refused(material("nowhere"), "'nowhere' is not one of ptfe")
refused(load_model("nowhere.json"), "No such file")
refused(evaluate(ptfe, 532, 95, 0, 30, 180), "geometry 1: theta_i = 95")
refused(evaluate(ptfe, 532, c(rep(5, 70000), 95), 0, 30, 180), "geometry 70001: theta_i = 95")   # in the second piece
refused(evaluate(ptfe, 532, c(1, NA), 0, 30, 180), "theta_i_deg[2] is NA")
refused(evaluate(ptfe, 532, 1:2, 0, 1:3, 180), "theta_i_deg has 2 values, must have 1 or 3")
refused(evaluate(ptfe, 532, "45", 0, 30, 180), "theta_i_deg must be numeric")
refused(evaluate(ptfe, -5, 45, 0, 30, 180), "wavelength")
for (wrong in list("532", TRUE, factor(532), list(532))) {
  refused(evaluate(ptfe, wrong, 45, 0, 30, 180), "wavelength_nm must be numeric")
  refused(evaluate_uncertainty(ptfe, wrong, 45, 0, 30, 180), "wavelength_nm must be numeric")
  refused(analyze(ptfe, wrong, 45, 0, 30, 180), "wavelength_nm must be numeric")
  refused(outside(ptfe, wrong, 45, 0, 30, 180), "wavelength_nm must be numeric")
  refused(dhr(ptfe, wrong, 45), "wavelength_nm must be numeric")
}
refused(evaluate(ptfe, NA_real_, 45, 0, 30, 180), "wavelength_nm[1] is NA")
for (wrong in list(-1, 1.5, NA, NaN, Inf, integer(0), 1:2, "2", 1e10)) {
  refused(evaluate(ptfe, 532, 45, 0, 30, 180, threads = wrong), "threads must be one whole number, 0 or more")
  refused(evaluate_uncertainty(ptfe, 532, 45, 0, 30, 180, threads = wrong), "threads must be one whole number")
  refused(analyze(ptfe, 532, 45, 0, 30, 180, threads = wrong), "threads must be one whole number")
  refused(predict(ptfe, newdata, threads = wrong), "threads must be one whole number")
}
refused(evaluate(ptfe, 532, 45, 0, 30, 180, frame = "ps"), "ps")
refused(evaluate("ptfe", 532, 45, 0, 30, 180), "model must be one of")
refused(analyze(ptfe, 532, 45, 0, 30, 180, names = "gloss"), "'gloss' is not known")
refused(predict(ptfe, as.list(newdata)), "newdata must be a data frame")
refused(predict(ptfe, newdata[-2]), "newdata has no column theta_i_deg")
