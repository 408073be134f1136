! SPDX-License-Identifier: BSD-3-Clause
program test
   use mmbrdf
   use, intrinsic :: iso_c_binding, only: c_int
   implicit none
   integer, parameter :: real64 = mmbrdf_real
   real(real64), parameter :: radian = 3.14159265358979323846_real64 / 180
   type(mmbrdf_model) :: model
   type(mmbrdf_prepared) :: at_532
   type(mmbrdf_error) :: error
   real(real64) :: g(4, 3), m(4, 4, 3), by_row(4, 4, 3), one(4, 4), u(4, 4, 3), value(3), u_value(3), dhr(3), u_dhr(3), f11(3)
   integer(c_int) :: outside(3)
   logical :: known(4, 4)
   integer :: q
   call mmbrdf_material("ptfe", model)
   call mmbrdf_prepare(model, 532._real64 / 1000, at_532)
   do q = 1, 3
      g(:, q) = [(20._real64 + 30 * (q - 1)) * radian, 10 * radian, (70._real64 - 30 * (q - 1)) * radian, 100 * radian]
   end do
   call mmbrdf_evaluate(at_532, g, m, frame="sp", convention="p_first_right")
   call mmbrdf_evaluate(at_532, g, by_row, frame="sp", convention="p_first_right", order=mmbrdf_row_major, threads=2)
   call mmbrdf_standard_uncertainty(at_532, g, u, frame="sp")
   call mmbrdf_analyze(at_532, "depolarization", g, value, u_value)
   call mmbrdf_dhr(at_532, g(:2, :), dhr, u_dhr)
   call mmbrdf_outside(at_532, g, outside)
   call mmbrdf_f11(at_532, g, f11)
   do q = 1, 3
      print "(a, 16es26.16e3)", "matrix", transpose(m(:, :, q))
      print "(a, 16es26.16e3)", "uncertainty", transpose(u(:, :, q))
      print "(a, 2es26.16e3)", "depolarization", value(q), u_value(q)
      print "(a, 2es26.16e3)", "dhr", dhr(q), u_dhr(q)
      print "(a, 1x, i0)", "outside", outside(q)
      if (maxval(abs(transpose(by_row(:, :, q)) - m(:, :, q))) > 0) error stop "orders differ"
      if (abs(f11(q) - m(1, 1, q)) > 0) error stop "f11 differs"
   end do
   call mmbrdf_evaluate(at_532, g(:, 2), one, frame="sp", convention="p_first_right")
   if (maxval(abs(one - m(:, :, 2))) > 0) error stop "one alone is another"
   call mmbrdf_known_elements(model, known)
   if (.not. all(known)) error stop "ptfe has all elements"
   call mmbrdf_evaluate(at_532, g, m(:, :, :2), error=error)
   call expect(mmbrdf_invalid_argument, "matrices has the shape 4, 4, 2, must be 4, 4, 3")
   call mmbrdf_standard_uncertainty(at_532, g, u(:, :, :2), error=error)
   call expect(mmbrdf_invalid_argument, "uncertainties has the shape 4, 4, 2, must be 4, 4, 3")
   call mmbrdf_f11(at_532, g, f11(:2), error=error)
   call expect(mmbrdf_invalid_argument, "f11 has the shape 2, must be 3")
   call mmbrdf_outside(at_532, g, outside(:2), error=error)
   call expect(mmbrdf_invalid_argument, "outside has the shape 2, must be 3")
   call mmbrdf_analyze(at_532, "depolarization", g, value(:2), u_value, error=error)
   call expect(mmbrdf_invalid_argument, "values has the shape 2, must be 3")
   call mmbrdf_analyze(at_532, "depolarization", g, value, u_value(:2), error=error)
   call expect(mmbrdf_invalid_argument, "uncertainties has the shape 2, must be 3")
   call mmbrdf_dhr(at_532, g(:2, :), dhr(:2), u_dhr, error=error)
   call expect(mmbrdf_invalid_argument, "dhr has the shape 2, must be 3")
   call mmbrdf_dhr(at_532, g, dhr, u_dhr, error=error)
   call expect(mmbrdf_invalid_argument, "directions_rad has the shape 4, 3, must be 2, 3")
   call mmbrdf_f11(at_532, g(:2, :), f11, error=error)
   call expect(mmbrdf_invalid_argument, "geometries_rad has the shape 2, 3, must be 4, 3")
   call mmbrdf_material("nowhere  ", model, error)
   call expect(mmbrdf_invalid_argument, "material 'nowhere' is not one of")
   call mmbrdf_load_model("nowhere.json", model, error)
   call expect(mmbrdf_failed, "nowhere.json")
   call mmbrdf_free(at_532)
   call mmbrdf_evaluate(at_532, g(:, 1), one, error=error)
   call expect(mmbrdf_invalid_argument, "prepared is null")
   call mmbrdf_free(model)

contains

   subroutine expect(code, message)
      integer(c_int), intent(in) :: code
      character(*), intent(in) :: message
      if (error%code == code .and. index(mmbrdf_message(error), message) > 0) return
      print "(2a)", "was told ", mmbrdf_message(error)
      error stop 1
   end subroutine
end program
