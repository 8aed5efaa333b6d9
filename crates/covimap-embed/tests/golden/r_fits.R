# What MASS::isoMDS and vegan::monoMDS make of the complete problems.
#
# Rscript r_fits.R
suppressMessages({
  library(MASS)
  library(vegan)
})
cat(R.version.string, "MASS", as.character(packageVersion("MASS")), "vegan", as.character(packageVersion("vegan")), "\n")

complete <- c("bent", "eurodist", "five_dimensions", "marks", "noisy_plane", "offset")

read_table <- function(name) {
  pairs <- read.csv(file.path("problems", name, "pairs.csv"))
  n <- max(pairs$j) + 1
  table <- matrix(0, n, n)
  table[cbind(pairs$i + 1, pairs$j + 1)] <- pairs$dissimilarity
  table[cbind(pairs$j + 1, pairs$i + 1)] <- pairs$dissimilarity
  as.dist(table)
}

mono <- function(table, points, ...) {
  monoMDS(table, y = points, k = 2, scaling = FALSE, pc = FALSE, maxit = 100000, smin = 1e-14, sfgrmin = 1e-14,
    sratmax = 1 - 1e-14, ...)$stress
}
methods <- list(
  "isoMDS primary" = function(table, points) {
    isoMDS(table, y = points, k = 2, maxit = 10000, trace = FALSE, tol = 1e-14)$stress / 100
  },
  "monoMDS primary" = function(table, points) mono(table, points, model = "global", weakties = TRUE),
  "monoMDS secondary" = function(table, points) mono(table, points, model = "global", weakties = FALSE),
  "monoMDS interval" = function(table, points) mono(table, points, model = "linear")
)

lines <- "problem,method,start,stress"
for (name in complete) {
  table <- read_table(name)
  starts <- read.csv(file.path("problems", name, "starts.csv"))
  for (method in names(methods)) for (start in unique(starts$start)) {
    points <- as.matrix(starts[starts$start == start, c("x", "y")])
    lines <- c(lines, sprintf("%s,%s,%d,%.17g", name, method, start, methods[[method]](table, points)))
  }
}
dir.create("expected", showWarnings = FALSE)
writeLines(lines, "expected/R.csv")
