! SPDX-License-Identifier: BSD-3-Clause
!> mmbrdf from Fortran: the calls of mmbrdf.h, which says what they do, with arrays in the place of pointers. Compile this file
!> with your own, since modules of one compiler are not those of another.
!>
!> Angles are in radians, wavelengths in micrometres, BRDFs in sr^-1. A geometry is a column of geometries_rad(4, n): theta_i,
!> phi_i (to the source), theta_r, phi_r (to the detector). matrices(i, j, q) is row i, column j of matrix q; with
!> order=mmbrdf_row_major it is matrices(j, i, q), as C has it. Uncertainties are standard (k = 1). Unknown is NaN.
!>
!> An error ends the program with a line, unless the call has the argument error: then error%code is 0 or one of the codes, and
!> mmbrdf_message(error) is the line. Handles may be used by all threads at once; each is freed once, by mmbrdf_free.
module mmbrdf
   use, intrinsic :: iso_c_binding
   use, intrinsic :: iso_fortran_env, only: error_unit
   implicit none
   private

   integer, parameter, public :: mmbrdf_real = c_double
   integer(c_int), parameter, public :: mmbrdf_row_major = 0, mmbrdf_column_major = 1
   integer(c_int), parameter, public :: mmbrdf_ok = 0, mmbrdf_invalid_argument = 1, mmbrdf_failed = 2, &
                                        mmbrdf_out_of_memory = 3, mmbrdf_internal = 4
   !> Of mmbrdf_outside: sums of these.
   integer(c_int), parameter, public :: mmbrdf_outside_theta_i = 1, mmbrdf_outside_theta_r = 2, &
                                        mmbrdf_outside_wavelength = 4, mmbrdf_unknown_range = 8, &
                                        mmbrdf_outside_directions = 16, mmbrdf_interpolated = 32

   type, bind(c), public :: mmbrdf_error
      integer(c_int) :: code = 0
      character(kind=c_char) :: message(500) = c_null_char
   end type
   type, public :: mmbrdf_model
      private
      type(c_ptr) :: handle = c_null_ptr
   end type
   !> A model at one wavelength.
   type, public :: mmbrdf_prepared
      private
      type(c_ptr) :: handle = c_null_ptr
   end type
   type, bind(c) :: layout_t
      integer(c_int) :: frame, convention, order
   end type
   public :: mmbrdf_material, mmbrdf_load_model, mmbrdf_prepare, mmbrdf_free, mmbrdf_message, mmbrdf_known_elements
   public :: mmbrdf_evaluate, mmbrdf_standard_uncertainty, mmbrdf_f11, mmbrdf_outside, mmbrdf_analyze, mmbrdf_dhr

   !> For n geometries, and for one alone: geometry_rad(4), matrix(4, 4).
   interface mmbrdf_evaluate
      module procedure evaluate_many, evaluate_one
   end interface
   interface mmbrdf_free
      module procedure free_model, free_prepared
   end interface
   interface
      integer(c_int) function c_material(name, model, error) bind(c, name="mmbrdf_material")
         import :: c_int, c_char, c_ptr, mmbrdf_error
         character(kind=c_char), intent(in) :: name(*)
         type(c_ptr), intent(out) :: model
         type(mmbrdf_error), intent(out) :: error
      end function
      integer(c_int) function c_prepare(model, wavelength_um, prepared, error) bind(c, name="mmbrdf_prepare")
         import :: c_int, c_double, c_ptr, mmbrdf_error
         type(c_ptr), value :: model
         real(c_double), value :: wavelength_um
         type(c_ptr), intent(out) :: prepared
         type(mmbrdf_error), intent(out) :: error
      end function
      subroutine c_free_model(model) bind(c, name="mmbrdf_free_model")
         import :: c_ptr
         type(c_ptr), value :: model
      end subroutine
      subroutine c_free_prepared(prepared) bind(c, name="mmbrdf_free_prepared")
         import :: c_ptr
         type(c_ptr), value :: prepared
      end subroutine
      integer(c_int) function c_layout_from(frame, convention, order, layout, error) bind(c, name="mmbrdf_layout_from")
         import :: c_int, c_char, layout_t, mmbrdf_error
         character(kind=c_char), intent(in) :: frame(*), convention(*)
         integer(c_int), value :: order
         type(layout_t), intent(out) :: layout
         type(mmbrdf_error), intent(out) :: error
      end function
      integer(c_int) function c_known_elements(model, layout, known, error) bind(c, name="mmbrdf_known_elements")
         import :: c_int, c_ptr, layout_t, mmbrdf_error
         type(c_ptr), value :: model
         type(layout_t), intent(in) :: layout
         integer(c_int), intent(out) :: known(16)
         type(mmbrdf_error), intent(out) :: error
      end function
      integer(c_int) function c_evaluate(prepared, n, geometries_rad, layout, threads, matrices, error) &
         bind(c, name="mmbrdf_evaluate")
         import :: c_int, c_int64_t, c_double, c_ptr, layout_t, mmbrdf_error
         type(c_ptr), value :: prepared
         integer(c_int64_t), value :: n
         real(c_double), intent(in) :: geometries_rad(*)
         type(layout_t), intent(in) :: layout
         integer(c_int), value :: threads
         real(c_double), intent(inout) :: matrices(*)
         type(mmbrdf_error), intent(out) :: error
      end function
      integer(c_int) function c_f11(prepared, n, geometries_rad, threads, f11, error) bind(c, name="mmbrdf_f11")
         import :: c_int, c_int64_t, c_double, c_ptr, mmbrdf_error
         type(c_ptr), value :: prepared
         integer(c_int64_t), value :: n
         real(c_double), intent(in) :: geometries_rad(*)
         integer(c_int), value :: threads
         real(c_double), intent(inout) :: f11(*)
         type(mmbrdf_error), intent(out) :: error
      end function
      integer(c_int) function c_outside(prepared, n, geometries_rad, outside, error) bind(c, name="mmbrdf_outside")
         import :: c_int, c_int64_t, c_double, c_ptr, mmbrdf_error
         type(c_ptr), value :: prepared
         integer(c_int64_t), value :: n
         real(c_double), intent(in) :: geometries_rad(*)
         integer(c_int), intent(inout) :: outside(*)
         type(mmbrdf_error), intent(out) :: error
      end function
      integer(c_int) function c_analyze(prepared, count, names, n, geometries_rad, threads, values, uncertainties, error) &
         bind(c, name="mmbrdf_analyze")
         import :: c_int, c_int64_t, c_double, c_ptr, mmbrdf_error
         type(c_ptr), value :: prepared
         integer(c_int), value :: count
         type(c_ptr), intent(in) :: names(*)
         integer(c_int64_t), value :: n
         real(c_double), intent(in) :: geometries_rad(*)
         integer(c_int), value :: threads
         real(c_double), intent(inout) :: values(*), uncertainties(*)
         type(mmbrdf_error), intent(out) :: error
      end function
      integer(c_int) function c_dhr(prepared, n, directions_rad, dhr, uncertainties, error) bind(c, name="mmbrdf_dhr")
         import :: c_int, c_int64_t, c_double, c_ptr, mmbrdf_error
         type(c_ptr), value :: prepared
         integer(c_int64_t), value :: n
         real(c_double), intent(in) :: directions_rad(*)
         real(c_double), intent(inout) :: dhr(*), uncertainties(*)
         type(mmbrdf_error), intent(out) :: error
      end function
   end interface
   procedure(c_material), bind(c, name="mmbrdf_load_model") :: c_load_model
   procedure(c_evaluate), bind(c, name="mmbrdf_standard_uncertainty") :: c_uncertainty

contains

   !> A built-in model.
   subroutine mmbrdf_material(name, model, error)
      character(*), intent(in) :: name
      type(mmbrdf_model), intent(out) :: model
      type(mmbrdf_error), intent(out), optional :: error
      type(mmbrdf_error) :: told
      integer(c_int) :: code
      code = c_material(text(name), model%handle, told)
      call tell(told, error)
   end subroutine

   !> A model from a file.
   subroutine mmbrdf_load_model(path, model, error)
      character(*), intent(in) :: path
      type(mmbrdf_model), intent(out) :: model
      type(mmbrdf_error), intent(out), optional :: error
      type(mmbrdf_error) :: told
      integer(c_int) :: code
      code = c_load_model(text(path), model%handle, told)
      call tell(told, error)
   end subroutine

   subroutine mmbrdf_prepare(model, wavelength_um, prepared, error)
      type(mmbrdf_model), intent(in) :: model
      real(c_double), intent(in) :: wavelength_um
      type(mmbrdf_prepared), intent(out) :: prepared
      type(mmbrdf_error), intent(out), optional :: error
      type(mmbrdf_error) :: told
      integer(c_int) :: code
      code = c_prepare(model%handle, wavelength_um, prepared%handle, told)
      call tell(told, error)
   end subroutine

   subroutine free_model(model)
      type(mmbrdf_model), intent(inout) :: model
      call c_free_model(model%handle)
      model%handle = c_null_ptr
   end subroutine

   subroutine free_prepared(prepared)
      type(mmbrdf_prepared), intent(inout) :: prepared
      call c_free_prepared(prepared%handle)
      prepared%handle = c_null_ptr
   end subroutine

   !> known(i, j): element ij was measured; others are NaN.
   subroutine mmbrdf_known_elements(model, known, frame, error)
      type(mmbrdf_model), intent(in) :: model
      logical, intent(out) :: known(4, 4)
      character(*), intent(in), optional :: frame
      type(mmbrdf_error), intent(out), optional :: error
      type(mmbrdf_error) :: told
      integer(c_int) :: code
      type(layout_t) :: layout
      integer(c_int) :: numbers(16)
      numbers = 0
      call find_layout(layout, told, frame=frame)
      if (told%code == 0) code = c_known_elements(model%handle, layout, numbers, told)
      known = reshape(numbers, [4, 4]) == 1
      call tell(told, error)
   end subroutine

   subroutine evaluate_many(prepared, geometries_rad, matrices, frame, convention, order, threads, error)
      type(mmbrdf_prepared), intent(in) :: prepared
      real(c_double), intent(in), contiguous :: geometries_rad(:, :)
      real(c_double), intent(inout), contiguous :: matrices(:, :, :)
      character(*), intent(in), optional :: frame, convention
      integer(c_int), intent(in), optional :: order, threads
      type(mmbrdf_error), intent(out), optional :: error
      type(mmbrdf_error) :: told
      integer(c_int) :: code
      type(layout_t) :: layout
      call find_layout(layout, told, frame, convention, order)
      call require(told, "geometries_rad", shape(geometries_rad), [4, size(geometries_rad, 2)])
      call require(told, "matrices", shape(matrices), [4, 4, size(geometries_rad, 2)])
      if (told%code == 0) code = c_evaluate(prepared%handle, size(geometries_rad, 2, c_int64_t), geometries_rad, &
                                                 layout, or_one(threads), matrices, told)
      call tell(told, error)
   end subroutine

   subroutine evaluate_one(prepared, geometry_rad, matrix, frame, convention, order, error)
      type(mmbrdf_prepared), intent(in) :: prepared
      real(c_double), intent(in) :: geometry_rad(4)
      real(c_double), intent(inout) :: matrix(4, 4)
      character(*), intent(in), optional :: frame, convention
      integer(c_int), intent(in), optional :: order
      type(mmbrdf_error), intent(out), optional :: error
      type(mmbrdf_error) :: told
      integer(c_int) :: code
      type(layout_t) :: layout
      call find_layout(layout, told, frame, convention, order)
      if (told%code == 0) &
         code = c_evaluate(prepared%handle, 1_c_int64_t, geometry_rad, layout, 1_c_int, matrix, told)
      call tell(told, error)
   end subroutine

   subroutine mmbrdf_standard_uncertainty(prepared, geometries_rad, uncertainties, frame, order, threads, error)
      type(mmbrdf_prepared), intent(in) :: prepared
      real(c_double), intent(in), contiguous :: geometries_rad(:, :)
      real(c_double), intent(inout), contiguous :: uncertainties(:, :, :)
      character(*), intent(in), optional :: frame
      integer(c_int), intent(in), optional :: order, threads
      type(mmbrdf_error), intent(out), optional :: error
      type(mmbrdf_error) :: told
      integer(c_int) :: code
      type(layout_t) :: layout
      call find_layout(layout, told, frame, order=order)
      call require(told, "geometries_rad", shape(geometries_rad), [4, size(geometries_rad, 2)])
      call require(told, "uncertainties", shape(uncertainties), [4, 4, size(geometries_rad, 2)])
      if (told%code == 0) code = c_uncertainty(prepared%handle, size(geometries_rad, 2, c_int64_t), geometries_rad, &
                                                    layout, or_one(threads), uncertainties, told)
      call tell(told, error)
   end subroutine

   subroutine mmbrdf_f11(prepared, geometries_rad, f11, threads, error)
      type(mmbrdf_prepared), intent(in) :: prepared
      real(c_double), intent(in), contiguous :: geometries_rad(:, :)
      real(c_double), intent(inout), contiguous :: f11(:)
      integer(c_int), intent(in), optional :: threads
      type(mmbrdf_error), intent(out), optional :: error
      type(mmbrdf_error) :: told
      integer(c_int) :: code
      call require(told, "geometries_rad", shape(geometries_rad), [4, size(geometries_rad, 2)])
      call require(told, "f11", shape(f11), [size(geometries_rad, 2)])
      if (told%code == 0) &
         code = c_f11(prepared%handle, size(f11, kind=c_int64_t), geometries_rad, or_one(threads), f11, told)
      call tell(told, error)
   end subroutine

   !> Of each geometry 0, or a sum of mmbrdf_outside_...
   subroutine mmbrdf_outside(prepared, geometries_rad, outside, error)
      type(mmbrdf_prepared), intent(in) :: prepared
      real(c_double), intent(in), contiguous :: geometries_rad(:, :)
      integer(c_int), intent(inout), contiguous :: outside(:)
      type(mmbrdf_error), intent(out), optional :: error
      type(mmbrdf_error) :: told
      integer(c_int) :: code
      call require(told, "geometries_rad", shape(geometries_rad), [4, size(geometries_rad, 2)])
      call require(told, "outside", shape(outside), [size(geometries_rad, 2)])
      if (told%code == 0) code = c_outside(prepared%handle, size(outside, kind=c_int64_t), geometries_rad, outside, told)
      call tell(told, error)
   end subroutine

   !> A derived quantity by its name, such as "depolarization", and its uncertainty.
   subroutine mmbrdf_analyze(prepared, name, geometries_rad, values, uncertainties, threads, error)
      type(mmbrdf_prepared), intent(in) :: prepared
      character(*), intent(in) :: name
      real(c_double), intent(in), contiguous :: geometries_rad(:, :)
      real(c_double), intent(inout), contiguous :: values(:), uncertainties(:)
      integer(c_int), intent(in), optional :: threads
      type(mmbrdf_error), intent(out), optional :: error
      type(mmbrdf_error) :: told
      integer(c_int) :: code
      character(kind=c_char), target :: letters(len(name) + 1)
      letters = text(name)
      call require(told, "geometries_rad", shape(geometries_rad), [4, size(geometries_rad, 2)])
      call require(told, "values", shape(values), [size(geometries_rad, 2)])
      call require(told, "uncertainties", shape(uncertainties), shape(values))
      if (told%code == 0) code = c_analyze(prepared%handle, 1_c_int, [c_loc(letters)], size(values, kind=c_int64_t), &
                                                geometries_rad, or_one(threads), values, uncertainties, told)
      call tell(told, error)
   end subroutine

   !> Directional-hemispherical reflectance of light from directions_rad(2, n): theta_i, phi_i.
   subroutine mmbrdf_dhr(prepared, directions_rad, dhr, uncertainties, error)
      type(mmbrdf_prepared), intent(in) :: prepared
      real(c_double), intent(in), contiguous :: directions_rad(:, :)
      real(c_double), intent(inout), contiguous :: dhr(:), uncertainties(:)
      type(mmbrdf_error), intent(out), optional :: error
      type(mmbrdf_error) :: told
      integer(c_int) :: code
      call require(told, "directions_rad", shape(directions_rad), [2, size(directions_rad, 2)])
      call require(told, "dhr", shape(dhr), [size(directions_rad, 2)])
      call require(told, "uncertainties", shape(uncertainties), shape(dhr))
      if (told%code == 0) code = c_dhr(prepared%handle, size(dhr, kind=c_int64_t), directions_rad, dhr, uncertainties, told)
      call tell(told, error)
   end subroutine

   !> The line that says what was wrong.
   function mmbrdf_message(error) result(line)
      type(mmbrdf_error), intent(in) :: error
      character(:), allocatable :: line
      integer :: i
      line = ""
      do i = 1, size(error%message)
         if (error%message(i) == c_null_char) exit
         line = line//error%message(i)
      end do
   end function

   !> As C has a text: without blanks at its end, and with a 0.
   pure function text(given) result(letters)
      character(*), intent(in) :: given
      character(kind=c_char) :: letters(len(given) + 1)
      integer :: i
      letters = c_null_char
      do i = 1, len_trim(given)
         letters(i) = given(i:i)
      end do
   end function

   pure integer(c_int) function or_one(threads)
      integer(c_int), intent(in), optional :: threads
      or_one = 1
      if (present(threads)) or_one = threads
   end function

   subroutine find_layout(layout, error, frame, convention, order)
      type(layout_t), intent(out) :: layout
      type(mmbrdf_error), intent(out) :: error
      character(*), intent(in), optional :: frame, convention
      integer(c_int), intent(in), optional :: order
      character(:), allocatable :: of_frame, of_convention
      integer(c_int) :: code
      layout = layout_t(0, 0, mmbrdf_column_major)
      if (present(order)) layout%order = order
      if (.not. (present(frame) .or. present(convention))) return
      of_frame = "xy"
      if (present(frame)) of_frame = frame
      of_convention = "germer2017"
      if (present(convention)) of_convention = convention
      code = c_layout_from(text(of_frame), text(of_convention), layout%order, layout, error)
   end subroutine

   !> What C cannot see: the shapes of arrays.
   subroutine require(error, name, is, must_be)
      type(mmbrdf_error), intent(inout) :: error
      character(*), intent(in) :: name
      integer, intent(in) :: is(:), must_be(:)
      character(200) :: line
      if (error%code /= 0 .or. all(is == must_be)) return
      write (line, "(2a, *(i0, :, ', '))") name, " has the shape ", is
      write (line, "(2a, *(i0, :, ', '))") trim(line), ", must be ", must_be
      error%code = mmbrdf_invalid_argument
      error%message(:len_trim(line) + 1) = text(trim(line))
   end subroutine

   subroutine tell(told, error)
      type(mmbrdf_error), intent(in) :: told
      type(mmbrdf_error), intent(out), optional :: error
      if (present(error)) then
         error = told
      else if (told%code /= 0) then
         write (error_unit, "(2a)") "mmbrdf: ", mmbrdf_message(told)
         stop 1
      end if
   end subroutine

end module
