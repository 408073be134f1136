/* SPDX-License-Identifier: BSD-3-Clause */
#include <mmbrdf.h>
#include <stdio.h>
#include <string.h>

static void print(const char* name, const double* numbers, int count) {
  printf("%s", name);
  for (int i = 0; i < count; ++i) printf(" %.17g", numbers[i]);
  printf("\n");
}

int main(void) {
  const mmbrdf_layout layout = {MMBRDF_SP, MMBRDF_P_FIRST_RIGHT, MMBRDF_ROW_MAJOR};
  const double radian = 3.14159265358979323846 / 180;
  const char* const name = "depolarization";
  mmbrdf_error e;
  mmbrdf_model* model;
  mmbrdf_prepared* at_532;
  if (strcmp(mmbrdf_version(), MMBRDF_VERSION) != 0) return 1;
  if (mmbrdf_evaluate(NULL, 1, NULL, NULL, 1, NULL, &e) != MMBRDF_INVALID_ARGUMENT) return 2;
  if (mmbrdf_material("ptfe", &model, &e) || mmbrdf_prepare(model, 532.0 / 1000, &at_532, &e)) return 3;
  mmbrdf_free_model(model); /* what is prepared needs it no more */
  for (int q = 0; q < 3; ++q) {
    const double g[4] = {(20.0 + 30 * q) * radian, 10 * radian, (70.0 - 30 * q) * radian, 100 * radian};
    double m[16], u[16], value[2], dhr[2];
    int outside;
    if (mmbrdf_evaluate(at_532, 1, g, &layout, 1, m, &e) ||
        mmbrdf_standard_uncertainty(at_532, 1, g, &layout, 1, u, &e) ||
        mmbrdf_analyze(at_532, 1, &name, 1, g, 1, value, value + 1, &e) || mmbrdf_dhr(at_532, 1, g, dhr, dhr + 1, &e) ||
        mmbrdf_outside(at_532, 1, g, &outside, &e)) {
      fprintf(stderr, "%s\n", e.message);
      return 4;
    }
    print("matrix", m, 16);
    print("uncertainty", u, 16);
    print("depolarization", value, 2);
    print("dhr", dhr, 2);
    printf("outside %d\n", outside);
  }
  mmbrdf_free_prepared(at_532);
  return 0;
}
