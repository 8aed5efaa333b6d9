# Writes the road distances between 21 European cities, in kilometres, that R ships as `eurodist`.
# They are facts: the table is in D. Crystal (ed.), The Cambridge Encyclopaedia, 1990.
#
# Rscript eurodist.R
table <- as.matrix(datasets::eurodist)
n <- nrow(table)
dir.create("problems/eurodist", recursive = TRUE, showWarnings = FALSE)
writeLines(rownames(table), "problems/eurodist/names.txt")
lines <- "i,j,dissimilarity,weight"
for (i in 1:(n - 1)) for (j in (i + 1):n) {
  lines <- c(lines, sprintf("%d,%d,%d,1", i - 1, j - 1, table[i, j]))
}
writeLines(lines, "problems/eurodist/pairs.csv")
