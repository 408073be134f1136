# SPDX-License-Identifier: BSD-3-Clause
# Degrees and nanometres, as people give them: radians and micrometres begin in src/.

materials <- function() .Call(C_materials)

material <- function(name) .Call(C_material, name)

load_model <- function(path) .Call(C_load_model, path.expand(path))

print.mmbrdf_model <- function(x, ...) {
  d <- .Call(C_describe, x)
  cat(d$name, ": ", d$basis, "\n", sep = "")
  cat("fitted to ", d$fitted_range, "\n", sep = "")
  if (!d$has_uncertainty) cat("uncertainties are not known\n")
  invisible(x)
}

known_elements <- function(model, frame = "xy") .Call(C_known_elements, model, frame)

quantities <- function() as.data.frame(.Call(C_quantities), stringsAsFactors = FALSE)

# All of the same length, or 1; numbers, and none of them NA.
recycled <- function(...) {
  given <- list(...)
  lengths <- lengths(given)
  n <- if (any(lengths == 0)) 0L else max(lengths)
  for (name in names(given)) {
    x <- given[[name]]
    if (!is.numeric(x)) stop(name, " must be numeric", call. = FALSE)
    if (anyNA(x)) stop(name, "[", which(is.na(x))[1], "] is NA", call. = FALSE)
    if (length(x) != n) {
      if (length(x) != 1 && n > 0)
        stop(name, " has ", length(x), " values, must have 1 or ", n, call. = FALSE)
      given[[name]] <- rep(x, length.out = n)
    }
    if (!is.double(x)) given[[name]] <- as.double(given[[name]])
  }
  given
}

threads_of <- function(threads) {
  if (!is.numeric(threads) || length(threads) != 1 || is.na(threads) || threads < 0 ||
      threads > .Machine$integer.max || threads != trunc(threads))
    stop("threads must be one whole number, 0 or more", call. = FALSE)
  as.integer(threads)
}

# call(wavelength_nm, theta_i, phi_i, theta_r, phi_r) for each wavelength, and its results put together by
# place(result, part, positions). With one wavelength nothing is copied.
by_wavelength <- function(wavelength_nm, angles, call, place) {
  recycled(wavelength_nm = wavelength_nm)
  if (length(wavelength_nm) == 1) return(do.call(call, c(wavelength_nm, unname(do.call(recycled, angles)))))
  given <- do.call(recycled, c(list(wavelength_nm = wavelength_nm), angles))
  result <- NULL
  for (wavelength in unique(given[[1]])) {
    at <- which(given[[1]] == wavelength)
    part <- do.call(call, c(wavelength, unname(lapply(given[-1], `[`, at))))
    result <- place(result, part, at, length(given[[1]]))
  }
  if (is.null(result)) do.call(call, list(1, numeric(), numeric(), numeric(), numeric())) else result
}

angles_of <- function(theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg)
  list(theta_i_deg = theta_i_deg, phi_i_deg = phi_i_deg, theta_r_deg = theta_r_deg, phi_r_deg = phi_r_deg)

place_matrices <- function(result, part, at, n) {
  if (is.null(result)) result <- array(NA_real_, c(4, 4, n))
  result[, , at] <- part
  result
}

# Columns by quantity.
place_rows <- function(result, part, at, n) {
  if (is.null(result)) result <- lapply(part, function(column) rep(column[NA_integer_], n))
  for (k in seq_along(part)) result[[k]][at] <- part[[k]]
  result
}

matrices <- function(what, model, wavelength_nm, angles, frame, convention, threads) {
  threads <- threads_of(threads)
  by_wavelength(wavelength_nm, angles,
    function(w, ti, pi, tr, pr) .Call(what, model, w, ti, pi, tr, pr, frame, convention, threads),
    place_matrices)
}

evaluate <- function(model, wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg, frame = "xy",
                     convention = "germer2017", threads = 0)
  matrices(C_evaluate, model, wavelength_nm, angles_of(theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg), frame,
           convention, threads)

evaluate_uncertainty <- function(model, wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg, frame = "xy",
                                 threads = 0)
  matrices(C_uncertainty, model, wavelength_nm, angles_of(theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg), frame,
           "germer2017", threads)

analyze <- function(model, wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg,
                    names = quantities()$name, threads = 0) {
  threads <- threads_of(threads)
  columns <- by_wavelength(wavelength_nm, angles_of(theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg),
    function(w, ti, pi, tr, pr) .Call(C_analyze, model, w, ti, pi, tr, pr, names, threads), place_rows)
  as.data.frame(columns)
}

outside <- function(model, wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg)
  by_wavelength(wavelength_nm, angles_of(theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg),
    function(w, ti, pi, tr, pr) list(.Call(C_outside, model, w, ti, pi, tr, pr)), place_rows)[[1]]

dhr <- function(model, wavelength_nm, theta_i_deg, phi_i_deg = 0) {
  angles <- angles_of(theta_i_deg, phi_i_deg, 0, 0)
  as.data.frame(by_wavelength(wavelength_nm, angles,
    function(w, ti, pi, tr, pr) .Call(C_dhr, model, w, ti, pi), place_rows))
}

predict.mmbrdf_model <- function(object, newdata, frame = "xy", convention = "germer2017", threads = 0, ...) {
  needed <- c("wavelength_nm", "theta_i_deg", "phi_i_deg", "theta_r_deg", "phi_r_deg")
  if (!is.data.frame(newdata)) stop("newdata must be a data frame", call. = FALSE)
  missing <- setdiff(needed, names(newdata))
  if (length(missing) > 0) stop("newdata has no column ", missing[1], call. = FALSE)
  angles <- as.list(newdata[needed[-1]])
  elements <- t(outer(1:4, 1:4, paste0))   # of rows, then columns
  by_row <- function(values, prefix) {
    columns <- aperm(values, c(3, 2, 1))
    dim(columns) <- c(nrow(newdata), 16)
    colnames(columns) <- paste0(prefix, elements)
    columns
  }
  f <- matrices(C_evaluate, object, newdata$wavelength_nm, angles, frame, convention, threads)
  u <- matrices(C_uncertainty, object, newdata$wavelength_nm, angles, frame, "germer2017", threads)
  outside <- do.call("outside", c(list(object, newdata$wavelength_nm), unname(angles)))
  cbind(newdata[needed], by_row(f, "f"), by_row(u, "u_f"), outside = outside)
}
