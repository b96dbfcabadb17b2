/* Comparison of doubles with an absolute tolerance (cmocka's own compares floats). Not-a-number is never near. Include after cmocka.h. */
#pragma once
#include <math.h>

#define assert_near(a, b, tolerance)                                                                                                                           \
  do {                                                                                                                                                         \
    const double near_a = (a), near_b = (b), near_tolerance = (tolerance);                                                                                     \
    if (!(fabs(near_a - near_b) <= near_tolerance))                                                                                                            \
      fail_msg("%s = %.16g, %s = %.16g differ by %.3g > %.3g", #a, near_a, #b, near_b, fabs(near_a - near_b), near_tolerance);                                 \
  } while (0)
