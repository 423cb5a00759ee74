//! What all vector registers share: arithmetic, one instruction per operation.

/// Implements [`Number`](crate::math::Number) and its operators for a register of `$lanes` f32, given the intrinsics.
macro_rules! arithmetic {
    ($register:ident, $lanes:literal, $raw:ty, $add:ident, $sub:ident, $mul:ident, $div:ident, $fmadd:ident, $fnmadd:ident, $min:ident, $max:ident, $sqrt:ident, $xor:ident, $and_not:ident, $splat:ident) => {
        impl Default for $register {
            #[inline(always)]
            fn default() -> Self {
                <$register as Number>::ZERO
            }
        }

        arithmetic!(@operator $register, Add, add, $add);
        arithmetic!(@operator $register, Sub, sub, $sub);
        arithmetic!(@operator $register, Mul, mul, $mul);
        arithmetic!(@operator $register, Div, div, $div);

        impl AddAssign for $register {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) {
                *self = *self + other;
            }
        }

        impl SubAssign for $register {
            #[inline(always)]
            fn sub_assign(&mut self, other: Self) {
                *self = *self - other;
            }
        }

        impl Neg for $register {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                // SAFETY: as for all registers, see the module.
                $register(unsafe { $xor(self.0, $splat(-0.0)) })
            }
        }

        impl Number for $register {
            // SAFETY: a register is its lanes in order.
            const ZERO: Self = $register(unsafe { transmute::<[f32; $lanes], $raw>([0.0; $lanes]) });
            // SAFETY: as above.
            const ONE: Self = $register(unsafe { transmute::<[f32; $lanes], $raw>([1.0; $lanes]) });

            #[inline(always)]
            fn from_f64(x: f64) -> Self {
                // SAFETY: as for all registers, see the module.
                $register(unsafe { $splat(x as f32) })
            }
            #[inline(always)]
            fn mul_plus(self, a: Self, b: Self) -> Self {
                // SAFETY: as for all registers, see the module.
                $register(unsafe { $fmadd(self.0, a.0, b.0) })
            }
            #[inline(always)]
            fn minus_product(self, a: Self, b: Self) -> Self {
                // SAFETY: as for all registers, see the module.
                $register(unsafe { $fnmadd(a.0, b.0, self.0) })
            }
            #[inline(always)]
            fn abs(self) -> Self {
                // SAFETY: as for all registers, see the module.
                $register(unsafe { $and_not($splat(-0.0), self.0) })
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                // SAFETY: as for all registers, see the module.
                $register(unsafe { $sqrt(self.0) })
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                // `self` unless `other` is smaller, as for one number.
                // SAFETY: as for all registers, see the module.
                $register(unsafe { $min(other.0, self.0) })
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                // SAFETY: as for all registers, see the module.
                $register(unsafe { $max(other.0, self.0) })
            }
            #[inline(always)]
            fn absorbed(self) -> Self {
                attenuation(self).0
            }
            #[inline(always)]
            fn mean_transmittance(self) -> Self {
                attenuation(self).1
            }
            #[inline(always)]
            fn absorbed_and_mean_transmittance(self) -> (Self, Self) {
                attenuation(self)
            }
        }
    };
    (@operator $register:ident, $trait:ident, $method:ident, $intrinsic:ident) => {
        impl $trait for $register {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: as for all registers, see the module.
                $register(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    };
}

/// Implements the operators of f64 in two registers, given the intrinsics.
macro_rules! operators {
    ($register:ident, $add:ident, $sub:ident, $mul:ident) => {
        operators!(@operator $register, Add, add, $add);
        operators!(@operator $register, Sub, sub, $sub);
        operators!(@operator $register, Mul, mul, $mul);
    };
    (@operator $register:ident, $trait:ident, $method:ident, $intrinsic:ident) => {
        impl $trait for $register {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let ([a, b], [c, d]) = (self.0, other.0);
                // SAFETY: as for all registers, see the module.
                $register(unsafe { [$intrinsic(a, c), $intrinsic(b, d)] })
            }
        }
    };
}

pub(super) use {arithmetic, operators};
